#include "depth_of_field_beside.glsl"

// Joins the parts of the background's lattices. Alpha is the lattice that a blurred texel was gathered from, and
// becomes 1; such texels take only such, all else stays.
vec4 depth_of_field_join_background(Pixel pixel, DepthOfFieldJoinBackgroundParams params, sampler2D background) {
    ivec2 last = textureSize(background, 0) - 1;
    vec4 own = texelFetch(background, pixel.index, 0);
    // A loop without a turn is what skips work here.
    int count = depth_of_field_joined(int(own.a));
    vec4 sum = depth_of_field_own_weight(count) * vec4(own.rgb, 1.0);
    for (int i = 0; i < count; ++i) {
        vec4 texel = texelFetch(background, clamp(pixel.index + depth_of_field_beside(i), ivec2(0), last), 0);
        sum += texel.a >= 1.0 ? depth_of_field_weight_beside(i) * vec4(texel.rgb, 1.0) : vec4(0.0);
    }
    return count > 0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(own.rgb, min(own.a, 1.0));
}
