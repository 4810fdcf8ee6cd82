#include "grain_film.glsl"

// How far a disc of that radius reaches through a pixel's square, pixels: see SeenDisc.
float grain_reach(float radius_squared) {
    return radius_squared > 1.0 / 3.0 ? 0.5 + sqrt(radius_squared - 1.0 / 12.0)
                                      : sqrt((5.0 + 12.0 * radius_squared) / 9.0);
}

// White noise on a square lattice, each point seen as a disc through a pixel: the weight falls to 0 over one pixel, up
// to 2 edges away. Up to 14 points, so that sums are close to Gaussian and the lattice does not show. Divided by the
// root of the summed squares, as grain_lattice(). frequency: edges per pixel; reach: edges.
vec3 grain_smooth(vec2 position, vec3 reach, float frequency, uint key) {
    vec2 corner = floor(position);
    vec2 offset = position - corner;
    uint place = grain_place(ivec2(corner) + 1); // -1 below is no neighbour of 0 in a word
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    for (int j = -1; j <= 2; ++j) {
        for (int i = -1; i <= 2; ++i) {
            vec3 weight = clamp(reach - distance(offset, vec2(i, j)), 0.0, frequency);
            sum += weight * grain_numbers(grain_word(place + uint(i + j * 0x10000), key));
            squares += weight * weight;
        }
    }
    return sum * inversesqrt(squares);
}

// Where much is covered, gaps between discs are what is seen, and they are smaller: the covariance of the Boolean
// model, (1 - u)^2 (e^(lambda overlap) - 1), takes an area in proportion to (1 - u)^0.3 within 4 % up to u = 0.9.
vec3 grain_gaussian(vec3 color, Pixel pixel, GrainGaussianParams params) {
    vec3 radius_squared = params.radius_squared * pow(clamp(1.0 - color, 0.001, 1.0), vec3(0.3));
    vec3 reach = params.frequency * vec3(grain_reach(radius_squared.r), grain_reach(radius_squared.g),
                                         grain_reach(radius_squared.b));
    vec3 field = grain_smooth(pixel.position * params.frequency, reach, params.frequency, grain_key(params.key));
    return grain_on(color, field, params.own, params.joint);
}
