#include "chromatic_aberration_three.glsl"
#include <postfx/depth.glsl>

// No lens does this: a lateral fringe does not vanish in focus.
vec3 chromatic_aberration_classic(vec3 color, Pixel pixel, ChromaticAberrationClassicParams params, sampler2D picture,
                                  sampler2D depth) {
    float z = postfx_view_z(texelFetch(depth, pixel.index, 0).r);
    float defocus = abs(z * params.inverse_focus_distance - 1.0);
    float focus = defocus < 1.0 ? defocus : 1.0; // also where the depth is NaN
    return chromatic_aberration_three(color, pixel.uv, focus * params.red, focus * params.blue, picture);
}
