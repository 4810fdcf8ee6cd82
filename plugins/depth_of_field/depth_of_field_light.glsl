#include <postfx/numeric.glsl>

// Light that can be summed: NaN as 0, infinities as the largest half float; 1e36 leaves room for sums in floats.
vec3 depth_of_field_light(vec3 light) {
    return clamp(postfx_finite_or(light, 65504.0), vec3(-1e36), vec3(1e36));
}
