#include "depth_of_field_beside.glsl"

// Joins the parts of the foreground's lattice.
vec4 depth_of_field_join_foreground(Pixel pixel, DepthOfFieldJoinForegroundParams params, sampler2D foreground,
                                    sampler2D reach) {
    ivec2 last = textureSize(foreground, 0) - 1;
    bool covered = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).r > 0.0;
    // A loop without a turn is what skips work here.
    int count = covered ? depth_of_field_joined(DEPTH_OF_FIELD_LATTICE) : 0;
    vec4 sum = depth_of_field_own_weight(count) * texelFetch(foreground, pixel.index, 0);
    for (int i = 0; i < count; ++i) {
        vec4 texel = texelFetch(foreground, clamp(pixel.index + depth_of_field_beside(i), ivec2(0), last), 0);
        sum += depth_of_field_weight_beside(i) * texel;
    }
    return sum;
}
