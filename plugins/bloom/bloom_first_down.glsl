#include "bloom_mirrored.glsl"
#include "bloom_source.glsl"

// The picture to half resolution, weights (1 3 3 1)/8 on each axis: dyadic, so a constant stays itself, and every
// texel's weights over the coarser level sum to 1/4 with their centroid on the texel, so light neither moves nor
// pulses with its position. Texel i of a level covers texels 2i and 2i+1 of the finer one at any size.
vec4 bloom_first_down(Pixel pixel, BloomFirstDownParams params, sampler2D source) {
    ivec2 size = textureSize(source, 0);
    ivec4 x = bloom_mirrored(2 * pixel.index.x + ivec4(-1, 0, 1, 2), size.x);
    ivec4 y = bloom_mirrored(2 * pixel.index.y + ivec4(-1, 0, 1, 2), size.y);
    const vec4 weight = vec4(0.125, 0.375, 0.375, 0.125);
    vec3 sum = vec3(0.0), seen = vec3(0.0);
    for (int j = 0; j < 4; ++j) {
        vec3 row = vec3(0.0);
        for (int i = 0; i < 4; ++i) {
            vec3 light = texelFetch(source, ivec2(x[i], y[j]), 0).rgb;
            row += weight[i] * bloom_glowing(light, params.knee_start, params.knee_end);
            seen += light;
        }
        sum += weight[j] * row;
    }
    // What is not finite is rare. A loop, since a branch may cost its whole length where no pixel takes it.
    int repairs = bloom_is_finite(seen) ? 0 : 16;
    if (repairs > 0) sum = vec3(0.0);
    for (int i = 0; i < repairs; ++i) {
        vec3 light = postfx_light(texelFetch(source, ivec2(x[i & 3], y[i >> 2]), 0).rgb);
        sum += weight[i & 3] * weight[i >> 2] * bloom_glowing(light, params.knee_start, params.knee_end);
    }
    return vec4(sum, 1.0);
}
