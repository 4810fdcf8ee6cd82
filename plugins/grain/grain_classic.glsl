#include "grain_sine.glsl"

vec3 grain_classic(vec3 color, Pixel pixel, GrainClassicParams params) {
    return grain_sine(color, pixel, params.amount);
}
