#include "grain_film.glsl"

// Weight of a lattice point at that offset: it reaches 0 at the height of a lattice triangle (square 0.5), so that
// the three corners of a triangle are all that counts inside it.
float grain_weight(vec2 offset) {
    float x = max(0.5 - dot(offset, offset), 0.0);
    return x * x;
}

// A smooth field on a triangular lattice (the simplex grid of Perlin 2001), which has no preferred axis as a square
// one has. Dividing by the root of the summed squares makes the variance exactly 1 at every pixel, not on average.
vec3 grain_lattice(vec2 position, uint key) {
    const float skew = 0.36602540;   // (sqrt(3) - 1) / 2
    const float unskew = 0.21132487; // (3 - sqrt(3)) / 6
    vec2 corner = floor(position + (position.x + position.y) * skew);
    vec2 offset = position - corner + (corner.x + corner.y) * unskew;
    bool is_lower = offset.x > offset.y;
    vec2 to_second = is_lower ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec3 weight = vec3(grain_weight(offset), grain_weight(offset - to_second + unskew),
                       grain_weight(offset - 1.0 + 2.0 * unskew));
    weight *= inversesqrt(dot(weight, weight));
    uint place = grain_place(ivec2(corner));
    return weight.x * grain_numbers(grain_word(place, key)) +
           weight.y * grain_numbers(grain_word(place + (is_lower ? 1u : 0x10000u), key)) +
           weight.z * grain_numbers(grain_word(place + 0x10001u, key));
}

vec3 grain(vec3 color, Pixel pixel, GrainParams params) {
    vec3 field = grain_lattice(pixel.position * params.frequency, grain_key(params.key));
    return grain_on(color, field, params.own, params.joint);
}
