#include "bloom_mirrored.glsl"
#include "bloom_source.glsl"

// The picture to a quarter of its resolution, weights (3 5 8 8 5 3)/32 on each axis in three linear samples. A
// texel's weights over the coarser level sum to 1/16; their centroid is at most half a pixel from it (for less than
// that it would take eight weights). Pixels that are no light are rare: where a sample shows one, they are held to light
// and the mean of the 4x4 pixels themselves has to do.
vec4 bloom_first_quarter(Pixel pixel, BloomFirstQuarterParams params, sampler2D source) {
    vec2 size = vec2(textureSize(source, 0)), center = 4.0 * pixel.position;
    vec3 sum = vec3(0.0);
    bool is_light = true;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            vec3 light = textureLod(source, bloom_mirrored(center + 1.875 * vec2(x, y), size, source), 0.0).rgb;
            float weight = (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
            sum += weight * bloom_glowing(light, params.knee_start, params.knee_end);
            is_light = is_light && postfx_is_light(light);
        }
    }
    // A loop, since a branch may cost its whole length where no pixel takes it.
    int repairs = is_light ? 0 : 16;
    if (repairs > 0) sum = vec3(0.0);
    ivec2 last = textureSize(source, 0) - 1;
    for (int i = 0; i < repairs; ++i) {
        ivec2 index = min(4 * pixel.index + ivec2(i & 3, i >> 2), last);
        vec3 light = postfx_light(texelFetch(source, index, 0).rgb);
        sum += 0.0625 * bloom_glowing(light, params.knee_start, params.knee_end);
    }
    return vec4(sum, 1.0);
}
