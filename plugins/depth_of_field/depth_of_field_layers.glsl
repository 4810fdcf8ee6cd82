#include "depth_of_field_circle.glsl"
#include "depth_of_field_light.glsl"

// Splits a block of pixels into what lies behind the focus plane and what lies before it, so that no later sum can mix
// a sharp or near surface into the blur behind it.
//   background  colour, blur radius [texels]: 0 in focus, -1 where the block shows nothing but blurred foreground
//   foreground  colour, 1 (0 where there is none)
//   shape       of the foreground: blur radius [texels], share of the block that it covers
void depth_of_field_layers(Pixel pixel, DepthOfFieldLayersParams params, sampler2D source, sampler2D depth,
                           out vec4 background, out vec4 foreground, out vec4 shape) {
    ivec2 last = textureSize(source, 0) - 1;
    vec4 far_sum = vec4(0.0), near_sum = vec4(0.0), sharp_sum = vec4(0.0); // light and weight
    float far_circle = 0.0, near_circle = 0.0;
    for (int y = 0; y < params.block; ++y) {
        for (int x = 0; x < params.block; ++x) {
            ivec2 at = min(params.block * pixel.index + ivec2(x, y), last);
            vec4 light = vec4(depth_of_field_light(texelFetch(source, at, 0).rgb), 1.0);
            float circle = depth_of_field_circle(texelFetch(depth, at, 0).r, params.lens);
            float share = clamp((abs(circle) - params.sharp_diameter) * params.softening, 0.0, 1.0);
            if (share > 0.0 && circle > 0.0) {
                far_sum += share * light;
                far_circle += share * circle;
            } else {
                sharp_sum += (1.0 - share) * light; // the sharp part of a near surface is background to nearer ones
                near_sum += share * light;
                near_circle -= share * circle;
            }
        }
    }
    float texels_per_diameter = 0.5 / float(params.block);
    background = vec4(0.0, 0.0, 0.0, -1.0);
    if (sharp_sum.a > 0.0) background = vec4(sharp_sum.rgb / sharp_sum.a, 0.0);
    if (far_sum.a > 0.0) {
        background = vec4(far_sum.rgb / far_sum.a, max(0.5, far_circle / far_sum.a * texels_per_diameter));
    }
    foreground = vec4(0.0);
    shape = vec4(0.0);
    if (near_sum.a > 0.0) {
        foreground = vec4(near_sum.rgb / near_sum.a, 1.0);
        shape.r = max(0.5, near_circle / near_sum.a * texels_per_diameter);
        shape.g = near_sum.a / float(params.block * params.block);
    }
}
