#include "chromatic_aberration_axis.glsl"
#include "chromatic_aberration_filtered.glsl"
#include "chromatic_aberration_spectrum.glsl"

// Changes that one end of the spectrum makes to its own channel and to green; `light` has these two.
vec2 chromatic_aberration_side(vec2 light, vec2 uv, vec2 displacement, bool is_red, int taps, sampler2D picture) {
    vec2 change = vec2(0.0);
    for (int i = 1; i <= taps; ++i) {
        vec3 found = chromatic_aberration_filtered(uv + (float(i) / float(taps)) * displacement, picture);
        change += chromatic_aberration_weights(i, taps) * ((is_red ? found.rg : found.bg) - light);
    }
    return change;
}

vec3 chromatic_aberration(vec3 color, Pixel pixel, ChromaticAberrationParams params, sampler2D picture) {
    vec2 from_axis = pixel.uv - chromatic_aberration_axis();
    vec3 light = postfx_light(color);
    vec2 red = chromatic_aberration_side(light.rg, pixel.uv, from_axis * params.red, true,
                                         CHROMATIC_ABERRATION_RED_TAPS, picture);
    vec2 blue = chromatic_aberration_side(light.bg, pixel.uv, from_axis * params.blue, false,
                                          CHROMATIC_ABERRATION_BLUE_TAPS, picture);
    return chromatic_aberration_sum(light, red, blue);
}
