#include "grain_film.glsl"

// How far a disc of that radius reaches through a pixel's square, pixels: see SeenDisc.
float grain_reach(float radius_squared) {
    return radius_squared > 1.0 / 3.0 ? 0.5 + sqrt(radius_squared - 1.0 / 12.0)
                                      : sqrt((5.0 + 12.0 * radius_squared) / 9.0);
}

// White noise on every second point of a square lattice, as on a chessboard, each point seen as a disc through a pixel:
// the weight falls to 0 over one pixel, up to 2 edges away. Up to 8 points. Divided by the root of the summed squares,
// as grain_lattice(). parity: of those points; reach: edges, over 1, so that a point is always within; frequency:
// edges per pixel.
vec3 grain_discs(vec2 offset, uint place, uint parity, vec3 reach, float frequency, uint key) {
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    for (int j = -1; j <= 2; ++j) {
        int first = -int((parity + uint(j)) & 1u);
        for (int step = 0; step < 2; ++step) {
            int i = first + 2 * step;
            vec3 weight = clamp(reach - distance(offset, vec2(i, j)), 0.0, frequency);
            sum += weight * grain_numbers(grain_word(place + uint(i + j * 0x10000), key));
            squares += weight * weight;
        }
    }
    return sum * inversesqrt(squares);
}

// Where discs overlap their covariance is that of the Boolean model, (1 - u)^2 (e^(lambda overlap) - 1). Its first term
// is the discs themselves, with the share lambda / (e^lambda - 1) of the variance; the rest falls faster, as of discs
// of half the area and less: gaps between discs are smaller than discs. Film's spectrum from dark to bright is nearest
// to that of such a mixture with these powers of 1 - u.
vec3 grain_gaussian(vec3 color, Pixel pixel, GrainGaussianParams params) {
    vec3 bare = pow(clamp(1.0 - color, 0.02, 1.0), vec3(0.2));
    vec3 radius_squared = 0.5 * params.radius_squared * bare;
    vec3 reach = params.frequency * vec3(grain_reach(radius_squared.r), grain_reach(radius_squared.g),
                                         grain_reach(radius_squared.b));
    vec2 position = pixel.position * params.frequency;
    vec2 corner = floor(position);
    uint place = grain_place(ivec2(corner) + 1); // -1 below is no neighbour of 0 in a word
    uint parity = uint(corner.x) + uint(corner.y), key = grain_key(params.key);
    vec3 discs = grain_discs(position - corner, place, parity, vec3(2.0), params.frequency, key);
    vec3 gaps = grain_discs(position - corner, place, parity + 1u, reach, params.frequency, key);
    return grain_on(color, bare * discs + sqrt(1.0 - bare * bare) * gaps, params.own, params.joint);
}
