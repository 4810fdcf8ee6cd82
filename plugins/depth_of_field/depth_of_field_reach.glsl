// What can reach a tile from itself and its neighbours. reach: the largest blur radius [texels] of foreground, 1 if
// any background is visible there, and the largest radius of background. blurred: 1 if anything there is not in focus;
// where nothing is, no layer is read but by pixels that stay as they are.
void depth_of_field_reach(Pixel pixel, DepthOfFieldReachParams params, sampler2D tiles, out vec4 reach, out vec4 blurred) {
    ivec2 last = textureSize(tiles, 0) - 1;
    vec4 most = vec4(0.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            most = max(most, texelFetch(tiles, clamp(pixel.index + ivec2(x, y), ivec2(0), last), 0));
        }
    }
    reach = vec4(most.rga, 0.0);
    blurred = vec4(most.b);
}
