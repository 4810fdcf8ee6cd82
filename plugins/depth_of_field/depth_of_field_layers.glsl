#include "depth_of_field_circle.glsl"
#include "depth_of_field_share.glsl"
#include <postfx/numeric.glsl>

// Radius [texels] of the disc that is gathered for a mean circle [px]. The block, the disc's soft edge and the
// interpolation spread light too; theirs is taken off, so that the whole has the circle's variance.
float depth_of_field_radius(float circle) {
    float radius = circle * (0.5 / float(DEPTH_OF_FIELD_BLOCK));
    return sqrt(max(radius * radius - DEPTH_OF_FIELD_SPREAD, 0.25));
}

// Splits a block of pixels into what lies behind the focus plane and what lies before it, so that no later sum can
// mix a sharp or near surface into the blur behind it.
//   background  colour, blur radius [texels]: 0 in focus, -1 where the block shows nothing but blurred foreground
//   foreground  colour, blur radius [texels]: 0 where there is none
//   thickness   of the foreground: share of the block that it covers, over the sum of its disc's weights
void depth_of_field_layers(Pixel pixel, DepthOfFieldLayersParams params, sampler2D source, sampler2D depth,
                           sampler2D discs, out vec4 background, out vec4 foreground, out vec4 thickness) {
    ivec2 last = textureSize(source, 0) - 1;
    vec4 far_sum = vec4(0.0), near_sum = vec4(0.0), sharp_sum = vec4(0.0); // light and weight
    float far_circle = 0.0, near_circle = 0.0;
    for (int y = 0; y < DEPTH_OF_FIELD_BLOCK; ++y) {
        for (int x = 0; x < DEPTH_OF_FIELD_BLOCK; ++x) {
            ivec2 at = min(DEPTH_OF_FIELD_BLOCK * pixel.index + ivec2(x, y), last);
            vec4 light = vec4(postfx_light(texelFetch(source, at, 0).rgb), 1.0);
            float circle = depth_of_field_circle(texelFetch(depth, at, 0).r, params.lens);
            float share = depth_of_field_share(circle);
            float far = circle > 0.0 ? share : 0.0;
            float near = circle > 0.0 ? 0.0 : share;
            far_sum += far * light;
            far_circle += far * circle;
            near_sum += near * light;
            near_circle -= near * circle;
            // The sharp part of a near surface is background to nearer ones.
            sharp_sum += (far > 0.0 ? 0.0 : 1.0 - share) * light;
        }
    }
    background = vec4(0.0, 0.0, 0.0, -1.0);
    if (sharp_sum.a > 0.0) background = vec4(sharp_sum.rgb / sharp_sum.a, 0.0);
    if (far_sum.a > 0.0) {
        background = vec4(far_sum.rgb / far_sum.a, depth_of_field_radius(far_circle / far_sum.a));
    }
    foreground = vec4(0.0);
    thickness = vec4(0.0);
    if (near_sum.a > 0.0) {
        float radius = depth_of_field_radius(near_circle / near_sum.a);
        int entries = textureSize(discs, 0).x - 1;
        float entry = clamp((radius - 0.5) * params.entries_per_texel, 0.0, float(entries));
        int below = min(int(entry), entries - 1);
        float weights = mix(texelFetch(discs, ivec2(below, 0), 0).r, texelFetch(discs, ivec2(below + 1, 0), 0).r,
                            entry - float(below));
        foreground = vec4(near_sum.rgb / near_sum.a, radius);
        thickness.r = near_sum.a / (float(DEPTH_OF_FIELD_BLOCK * DEPTH_OF_FIELD_BLOCK) * weights);
    }
}
