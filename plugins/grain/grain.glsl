#include <postfx/noise.glsl>

// Stream of postfx_pixel_noise() that belongs to this file.
const uint GRAIN_STREAM = 0x6a11eu;

// Three independent numbers of mean 0 and variance 1 for a place of this frame: uniform in +-sqrt(3).
vec3 grain_at(ivec2 place) {
    return (2.0 * postfx_pixel_noise(place, GRAIN_STREAM) - 1.0) * 1.7320508;
}

// Weight of a lattice point at that offset: it reaches 0 at the height of a lattice triangle (square 0.5), so that
// the three corners of a triangle are all that counts inside it.
float grain_weight(vec2 offset) {
    float x = max(0.5 - dot(offset, offset), 0.0);
    return x * x;
}

// A smooth field on a triangular lattice (the simplex grid of Perlin 2001), which has no preferred axis as a square
// one has. Dividing by the root of the summed squares makes the variance exactly 1 at every pixel, not on average.
vec3 grain_clumps(vec2 position) {
    const float skew = 0.36602540;   // (sqrt(3) - 1) / 2
    const float unskew = 0.21132487; // (3 - sqrt(3)) / 6
    vec2 corner = floor(position + (position.x + position.y) * skew);
    vec2 offset = position - corner + (corner.x + corner.y) * unskew;
    vec2 step_to_second = offset.x > offset.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec3 weight = vec3(grain_weight(offset), grain_weight(offset - step_to_second + unskew),
                       grain_weight(offset - 1.0 + 2.0 * unskew));
    ivec2 lattice = ivec2(corner);
    vec3 sum = weight.x * grain_at(lattice) + weight.y * grain_at(lattice + ivec2(step_to_second)) +
               weight.z * grain_at(lattice + 1);
    return sum * inversesqrt(dot(weight, weight));
}

// Mean u and variance proportional to u (1 - u), as the Boolean model of grains gives (Newson, Delon, Galerne 2017).
vec3 grain(vec3 color, Pixel pixel, GrainParams params) {
    vec3 field = GRAIN_CLUMPS != 0 ? grain_clumps(pixel.position * params.frequency) : grain_at(pixel.index);
    field = params.own * field + params.joint * (field.r + field.g + field.b);
    vec3 deviation = params.sigma * sqrt(max(color * (1.0 - color), 0.0));
    // Light can't go below 0 nor above 1. Both tails are cut at the nearer end, so the mean stays; outside 0..1 there
    // is no room, and the light passes as it is.
    vec3 room = max(min(color, 1.0 - color), 0.0);
    return color + clamp(deviation * field, -room, room);
}
