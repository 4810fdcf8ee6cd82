#include <postfx/color.glsl>
#include <postfx/numeric.glsl>

// Fit of the ACES reference rendering and sRGB output transforms (S. Hill 2016, "BakingLab", ACES.hlsl, MIT), with
// the exposure that puts grey 0.18 near 0.21. The fit's constant -0.000090537 is left out: it would make everything
// below 0.002 black, and T(0) = 0 only by clipping; the curve moves by less than 4e-4.
vec3 tonemap_aces(vec3 light) {
    // sRGB to ACES AP1 and the reference rendering's desaturation, columns; and middle grey's exposure.
    const mat3 to_film =
        mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777) * (1.0 / 0.6);
    const mat3 to_display =
        mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 film = to_film * light;
    film = film * (film + 0.0245786) / (film * (0.983729 * film + 0.4329510) + 0.238081);
    return to_display * film;
}

// Extended operator on luminance (Reinhard et al. 2002, equation 4): hue and saturation stay. What is then brighter
// than the display can show in one channel is mixed with grey of the same luminance until it fits.
vec3 tonemap_reinhard(vec3 light, float white) {
    float luminance = postfx_luminance(light);
    float scale = (1.0 + luminance / (white * white)) / (1.0 + luminance);
    vec3 mapped = light * scale;
    float grey = min(luminance * scale, 1.0);
    float brightest = max(max(mapped.r, mapped.g), mapped.b);
    return brightest > 1.0 ? grey + (mapped - grey) * ((1.0 - grey) / (brightest - grey)) : mapped;
}

// Hable 2010, "Uncharted 2: HDR Lighting": A .15, B .50, C .10, D .20, E .02, F .30, white 11.2, exposure bias 2. The
// published (x(Ax + CB) + DE) / (x(Ax + B) + DF) - E/F is written over one denominator, which makes T(0) exactly 0.
vec3 tonemap_hable_curve(vec3 x) {
    return x * (0.14 * x + 0.05 / 3.0) / (x * (0.15 * x + 0.5) + 0.06);
}

vec3 tonemap_hable(vec3 light) {
    return tonemap_hable_curve(2.0 * light) / tonemap_hable_curve(vec3(11.2));
}

// No display shows negative light, and what is not a number is black. As integers, both lie above all that is not
// negative: one comparison finds them, without trusting comparisons with NaN. Every operator has long reached white at
// the brightest light, and its square is far from float's limit.
float tonemap_light(float x) {
    return floatBitsToUint(x) > 0x7f800000u ? 0.0 : min(x, POSTFX_BRIGHTEST);
}

vec3 tonemap(vec3 color, Pixel pixel, TonemapParams params) {
    vec3 exposed = color * params.gain;
    vec3 light = vec3(tonemap_light(exposed.r), tonemap_light(exposed.g), tonemap_light(exposed.b));
    vec3 mapped = TONEMAP_OPERATOR == 0   ? tonemap_aces(light)
                  : TONEMAP_OPERATOR == 1 ? tonemap_reinhard(light, params.white)
                  : TONEMAP_OPERATOR == 2 ? tonemap_hable(light)
                                          : light;
    return clamp(mapped, 0.0, 1.0);
}
