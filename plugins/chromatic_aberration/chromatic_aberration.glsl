#include <postfx/numeric.glsl>

// What a sample counts for: NaN as black and infinity as 65504, so that neither reaches other pixels; 1e38 leaves room
// for differences.
vec3 chromatic_aberration_light(vec3 color) {
    return clamp(postfx_finite_or(color, 65504.0), -1e38, 1e38);
}

// Changes that one end of the spectrum makes to its own channel (`primary`) and to green. The primary's kernel rises
// linearly from green's wavelength to its own, green's falls (half of green's kernel lies on either side). The
// image between taps is taken as linear, and the kernels are integrated over it exactly: whatever the number of taps,
// the weights of a channel sum to 1 and its mean displacement is right. Green's wavelength itself is not displaced;
// its tap is `color`, and its weight is what the others leave, so that a constant stays as it is to the last bit.
vec3 chromatic_aberration_side(vec3 color, vec2 uv, vec2 displacement, vec3 primary, int taps, sampler2D picture) {
    const vec3 green = vec3(0.0, 1.0, 0.0);
    float width = 1.0 / float(taps);
    vec3 change = vec3(0.0);
    for (int i = 1; i <= taps; ++i) {
        float along = float(i) * width;
        float primary_weight = i < taps ? 2.0 * width * along : width - width * width / 3.0;
        float green_weight = i < taps ? width * (1.0 - along) : width * width / 6.0;
        vec3 light = chromatic_aberration_light(textureLod(picture, uv + along * displacement, 0.0).rgb);
        change += (primary_weight * primary + green_weight * green) * (light - color);
    }
    return change;
}

vec3 chromatic_aberration(vec3 color, Pixel pixel, ChromaticAberrationParams params, sampler2D picture) {
    vec2 from_center = pixel.uv - 0.5;
    vec3 light = chromatic_aberration_light(color);
    return light +
           chromatic_aberration_side(light, pixel.uv, from_center * params.red, vec3(1.0, 0.0, 0.0),
                                     CHROMATIC_ABERRATION_RED_TAPS, picture) +
           chromatic_aberration_side(light, pixel.uv, from_center * params.blue, vec3(0.0, 0.0, 1.0),
                                     CHROMATIC_ABERRATION_BLUE_TAPS, picture);
}
