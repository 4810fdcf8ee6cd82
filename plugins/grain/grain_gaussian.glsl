#include "grain_film.glsl"

// White noise on a square lattice, seen through a round kernel of radius 2: 10 to 14 points, so that sums are close
// to Gaussian and the lattice does not show. Divided by the root of the summed squares, as grain_lattice().
vec3 grain_smooth(vec2 position, uint key) {
    vec2 corner = floor(position);
    vec2 offset = position - corner;
    uint place = grain_place(ivec2(corner) + 1); // -1 below is no neighbour of 0 in a word
    vec3 sum = vec3(0.0);
    float squares = 0.0;
    for (int j = -1; j <= 2; ++j) {
        for (int i = -1; i <= 2; ++i) {
            vec2 away = offset - vec2(i, j);
            float inside = max(1.0 - 0.25 * dot(away, away), 0.0);
            float weight = inside * inside;
            sum += weight * grain_numbers(grain_word(place + uint(i + j * 0x10000), key));
            squares += weight * weight;
        }
    }
    return sum * inversesqrt(squares);
}

vec3 grain_gaussian(vec3 color, Pixel pixel, GrainGaussianParams params) {
    vec3 field = grain_smooth(pixel.position * params.frequency, grain_key(params.key));
    return grain_on(color, field, params.own, params.joint);
}
