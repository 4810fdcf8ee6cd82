#include <postfx/color.glsl>

// Moves a pixel towards the tint of the same luminance. `params` has the parameters that my_effect.cpp declares.
vec3 my_effect(vec3 color, Pixel pixel, MyEffectParams params) {
    return mix(color, postfx_luminance(color) * params.tint, params.amount);
}
