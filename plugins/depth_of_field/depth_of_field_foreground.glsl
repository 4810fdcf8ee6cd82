#include "depth_of_field_gathered.glsl"

// The foreground: colour times coverage, coverage.
vec4 depth_of_field_foreground(Pixel pixel, DepthOfFieldForegroundParams params, sampler2D first, sampler2D second,
                               sampler2D third, sampler2D fourth) {
    return depth_of_field_gathered(pixel.index, first, second, third, fourth);
}
