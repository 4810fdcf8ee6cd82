#include <postfx/numeric.glsl>

// One texel of the source as light: non-negative, and above the threshold if there is one.
vec3 bloom_light(vec3 light, bool repair, float knee_start, float knee_end) {
    if (repair) light = min(postfx_finite_or(light, 65504.0), vec3(1e38));
    light = max(vec3(0.0), light);
    if (BLOOM_HAS_THRESHOLD == 0) return light;
    float brightness = max(light.r, max(light.g, light.b));
    if (brightness <= knee_start) return vec3(0.0);
    float above = brightness - 0.5 * (knee_start + knee_end);
    if (brightness < knee_end) { // parabola that meets 0 and `above` with their slopes
        float into = brightness - knee_start;
        above = into * into / (2.0 * (knee_end - knee_start));
    }
    return light * (above / brightness);
}

// Weights (1 3 3 1)/8 on each axis: dyadic, so a constant stays itself, and every texel's weights over the coarser
// level sum to 1/4 with their centroid on the texel, so light neither moves nor pulses with its position.
vec3 bloom_gather_source(Pixel pixel, BloomFirstDownParams params, sampler2D source, bool repair) {
    ivec2 last = textureSize(source, 0) - 1;
    ivec4 x = clamp(2 * pixel.index.x + ivec4(-1, 0, 1, 2), 0, last.x);
    ivec4 y = clamp(2 * pixel.index.y + ivec4(-1, 0, 1, 2), 0, last.y);
    const vec4 weight = vec4(0.125, 0.375, 0.375, 0.125);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 4; ++j) {
        vec3 row = vec3(0.0);
        for (int i = 0; i < 4; ++i) {
            vec3 texel = texelFetch(source, ivec2(x[i], y[j]), 0).rgb;
            row += weight[i] * bloom_light(texel, repair, params.knee_start, params.knee_end);
        }
        sum += weight[j] * row;
    }
    return sum;
}

// The picture to half resolution. Texel i of a level covers texels 2i and 2i+1 of the finer one at any size; past the
// edge the last texel repeats. Non-finite texels are rare: they are repaired only where a sum shows one.
vec4 bloom_first_down(Pixel pixel, BloomFirstDownParams params, sampler2D source) {
    vec3 sum = bloom_gather_source(pixel, params, source, false);
    bool finite = postfx_is_finite(sum.r) && postfx_is_finite(sum.g) && postfx_is_finite(sum.b);
    if (!finite) sum = bloom_gather_source(pixel, params, source, true);
    return vec4(sum, 1.0);
}
