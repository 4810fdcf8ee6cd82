#include "depth_of_field_circle.glsl"

// The circle's diameter [px]: red in front of the focus, blue behind.
vec3 depth_of_field_view(vec3 color, Pixel pixel, DepthOfFieldViewParams params, sampler2D depth) {
    float circle = depth_of_field_circle(texelFetch(depth, pixel.index, 0).r, params.lens);
    return vec3(max(-circle, 0.0), 0.0, max(circle, 0.0));
}
