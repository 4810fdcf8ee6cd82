// Whether tiles of a square are to be drawn: blurred where anything in reach is not in focus, covered where foreground
// reaches.
void depth_of_field_mask(Pixel pixel, DepthOfFieldMaskParams params, sampler2D reach, sampler2D blurred,
                         out vec4 any_blurred, out vec4 any_covered) {
    ivec2 last = textureSize(reach, 0) - 1;
    any_blurred = any_covered = vec4(0.0);
    for (int y = 0; y < DEPTH_OF_FIELD_MASK; ++y) {
        for (int x = 0; x < DEPTH_OF_FIELD_MASK; ++x) {
            ivec2 at = min(DEPTH_OF_FIELD_MASK * pixel.index + ivec2(x, y), last);
            any_blurred = max(any_blurred, vec4(texelFetch(blurred, at, 0).r));
            any_covered = texelFetch(reach, at, 0).r > 0.0 ? vec4(1.0) : any_covered;
        }
    }
}
