#include "grain_sine.glsl"
#include <postfx/depth.glsl>

vec3 grain_classic_focus(vec3 color, Pixel pixel, GrainClassicFocusParams params, sampler2D depth) {
    float z = postfx_view_z(texelFetch(depth, pixel.index, 0).r);
    float defocus = abs(z * params.inverse_focus_distance - 1.0);
    return grain_sine(color, pixel, params.amount * (defocus < 1.0 ? defocus : 1.0));
}
