#include "bloom_glow.glsl"
#include "bloom_source.glsl"

// Adds the glow, with what stays in its pixel of light that is no part of the picture, or that was made by a pass.
vec3 bloom_over_light(vec3 color, Pixel pixel, BloomOverLightParams params, sampler2D glow, sampler2D light) {
    vec3 staying = max(vec3(0.0), postfx_light(texelFetch(light, pixel.index, 0).rgb));
    return bloom_added(color, params.gain * bloom_glow(pixel, params.uv_per_pixel, glow) + params.own * staying);
}
