// What can reach a tile from itself and its neighbours: the largest blur radius [texels] of foreground, and 1 if any
// background is visible there.
vec4 depth_of_field_reach(Pixel pixel, DepthOfFieldReachParams params, sampler2D tiles) {
    ivec2 last = textureSize(tiles, 0) - 1;
    vec2 reach = vec2(0.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            reach = max(reach, texelFetch(tiles, clamp(pixel.index + ivec2(x, y), ivec2(0), last), 0).rg);
        }
    }
    return vec4(reach, 0.0, 0.0);
}
