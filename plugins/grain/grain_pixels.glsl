#include "grain_film.glsl"

// Grains up to a pixel: each pixel has its own number, of which more are summed the closer to Gaussian it is to be.
vec3 grain_pixels(vec3 color, Pixel pixel, GrainPixelsParams params) {
    uint word = grain_word(grain_place(pixel.index), grain_key(params.key));
    vec3 field = grain_numbers(word);
    for (int i = 1; i < GRAIN_NUMBERS; ++i) {
        word = grain_mixed(word + 0x9e3779b9u);
        field += grain_numbers(word);
    }
    return grain_on(color, field * inversesqrt(float(GRAIN_NUMBERS)), params.own, params.joint);
}
