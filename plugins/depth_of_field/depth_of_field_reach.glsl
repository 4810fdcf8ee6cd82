// Largest blur radius [texels] of any foreground that can reach a tile: that of the tile and its neighbours.
vec4 depth_of_field_reach(Pixel pixel, DepthOfFieldReachParams params, sampler2D tiles) {
    ivec2 last = textureSize(tiles, 0) - 1;
    float radius = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            radius = max(radius, texelFetch(tiles, clamp(pixel.index + ivec2(x, y), ivec2(0), last), 0).r);
        }
    }
    return vec4(radius);
}
