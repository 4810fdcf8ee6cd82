#include "bloom_bilinear.glsl"

// The half-resolution glow and the picture it joins.
vec3 bloom(vec3 color, Pixel pixel, BloomParams params, sampler2D glow) {
    vec3 scattered = bloom_bilinear(pixel.index, glow);
    vec3 room = max(vec3(0.0), params.ceiling - color);
    return params.kept * color + min(params.gain * scattered, room);
}
