#include "bloom_source.glsl"

vec3 bloom_neighbour(ivec2 index, sampler2D source) {
    ivec2 last = textureSize(source, 0) - 1;
    return max(vec3(0.0), postfx_light(texelFetch(source, clamp(index, ivec2(0), last), 0).rgb));
}

// What glows, pixel by pixel. A pixel brighter than 1 / firefly_guard times the mean of its eight neighbours counts
// as that: a ratio, so the guard knows no absolute brightness, and neither constant light nor black changes.
vec4 bloom_light(Pixel pixel, BloomLightParams params, sampler2D source) {
    vec3 light = postfx_light(texelFetch(source, pixel.index, 0).rgb);
    if (BLOOM_HAS_FIREFLY_GUARD == 1) {
        float around = -max(0.0, bloom_brightness(light));
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                around += bloom_brightness(bloom_neighbour(pixel.index + ivec2(x, y), source));
            }
        }
        float guarded = params.firefly_guard * bloom_brightness(light);
        float mean = 0.125 * max(0.0, around);
        if (guarded > mean) light *= mean / guarded;
    }
    return vec4(bloom_glowing(light, params.knee_start, params.knee_end), 1.0);
}
