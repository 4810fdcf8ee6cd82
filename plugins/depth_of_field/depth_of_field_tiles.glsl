// Largest blur radius [texels] of the foreground in a tile; 0 where there is none.
vec4 depth_of_field_tiles(Pixel pixel, DepthOfFieldTilesParams params, sampler2D shape) {
    ivec2 last = textureSize(shape, 0) - 1;
    float radius = 0.0;
    for (int y = 0; y < DEPTH_OF_FIELD_TILE; ++y) {
        for (int x = 0; x < DEPTH_OF_FIELD_TILE; ++x) {
            ivec2 at = min(DEPTH_OF_FIELD_TILE * pixel.index + ivec2(x, y), last);
            radius = max(radius, texelFetch(shape, at, 0).r);
        }
    }
    return vec4(radius);
}
