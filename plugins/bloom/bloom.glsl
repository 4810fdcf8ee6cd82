#include "bloom_glow.glsl"
#include "bloom_source.glsl"

// The picture's own light and the glow. Where glow is added and the image of it lacks what stays in its pixel
// (BLOOM_STAYS), that is taken from the picture.
vec3 bloom(vec3 color, Pixel pixel, BloomParams params, sampler2D glow) {
    vec3 leaving = params.gain * bloom_glow(pixel, params.uv_per_pixel, glow);
    if (BLOOM_ADDS == 0) return params.own * color + leaving;
    if (BLOOM_STAYS == 0) return bloom_added(color, leaving);
    vec3 staying = bloom_glowing(postfx_light(color), params.knee_start, params.knee_end);
    return bloom_added(color, leaving + params.own * staying);
}
