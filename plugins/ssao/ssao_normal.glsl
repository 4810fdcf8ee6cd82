#include <postfx/numeric.glsl>

// The unit normal, or 0 if the given one gives no direction.
vec3 ssao_unit_normal(vec3 given) {
    float squared = dot(given, given);
    bool usable = postfx_is_finite(squared) && squared > 0.01 && squared < 100.0;
    return usable ? given * inversesqrt(squared) : vec3(0.0);
}
