#include "depth_of_field_circle.glsl"

// Signed diameter of every pixel's circle.
vec4 depth_of_field_circles(Pixel pixel, DepthOfFieldCirclesParams params, sampler2D depth) {
    return vec4(depth_of_field_circle(texelFetch(depth, pixel.index, 0).r, params.lens), 0.0, 0.0, 0.0);
}
