// Of a tile: the largest blur radius [texels] of its foreground, 0 where there is none; 1 if any background is
// visible; 1 if anything in it is not in focus; the largest radius of its background.
vec4 depth_of_field_tiles(Pixel pixel, DepthOfFieldTilesParams params, sampler2D foreground, sampler2D background) {
    ivec2 last = textureSize(foreground, 0) - 1;
    float radius = 0.0, visible = 0.0, blurred = 0.0, far_radius = 0.0;
    for (int y = 0; y < DEPTH_OF_FIELD_TILE; ++y) {
        for (int x = 0; x < DEPTH_OF_FIELD_TILE; ++x) {
            ivec2 at = min(DEPTH_OF_FIELD_TILE * pixel.index + ivec2(x, y), last);
            float before = texelFetch(foreground, at, 0).a, behind = texelFetch(background, at, 0).a;
            radius = max(radius, before);
            far_radius = max(far_radius, behind);
            visible = behind >= 0.0 ? 1.0 : visible;
            blurred = behind != 0.0 || before > 0.0 ? 1.0 : blurred;
        }
    }
    return vec4(radius, visible, blurred, far_radius);
}
