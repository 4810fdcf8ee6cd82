#include "grain_film.glsl"

// Each pixel has its own number.
vec3 grain_pixels(vec3 color, Pixel pixel, GrainPixelsParams params) {
    vec3 field = grain_numbers(grain_word(grain_place(pixel.index), grain_key(params.key)));
    return grain_on(color, field, params.own, params.joint);
}
