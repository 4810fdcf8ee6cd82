#include "depth_of_field_circle.glsl"
#include <postfx/numeric.glsl>

// The naive blur: the mean of a square around the pixel, of a whole number of pixels that its own circle gives.
// Sharp surfaces leak into the blur beside them, near ones keep sharp edges, and the steps of the radius show.
vec4 depth_of_field_classic(Pixel pixel, DepthOfFieldClassicParams params, sampler2D source, sampler2D depth) {
    int radius = int(0.5 * abs(depth_of_field_circle(texelFetch(depth, pixel.index, 0).r, params.lens)));
    ivec2 last = pixel.size - 1;
    vec3 sum = vec3(0.0);
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            ivec2 at = clamp(pixel.index + ivec2(x, y), ivec2(0), last);
            sum += postfx_light(texelFetch(source, at, 0).rgb);
        }
    }
    float side = float(2 * radius + 1);
    return vec4(sum / (side * side), radius == 0 ? 0.0 : 1.0);
}
