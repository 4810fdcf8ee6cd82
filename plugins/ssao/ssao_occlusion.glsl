#include "ssao_distance.glsl"

// A pixel's occlusion, from the texels around it that are of its own surface.
float ssao_occlusion(Pixel pixel, float radius, sampler2D depth, sampler2D occlusion) {
    if (SSAO_BLOCK == 1) return clamp(texelFetch(occlusion, pixel.index, 0).r, 0.0, 1.0);
    float z = ssao_distance(texelFetch(depth, pixel.index, 0).r);
    if (z == SSAO_NOTHING) return 0.0;
    ivec2 corner = pixel.index / SSAO_BLOCK, last = textureSize(occlusion, 0) - 1;
    vec2 fraction = vec2(pixel.index - SSAO_BLOCK * corner) / float(SSAO_BLOCK);
    float tolerance = 0.25 * radius;
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        vec2 part = mix(1.0 - fraction, fraction, vec2(offset));
        vec2 texel = texelFetch(occlusion, min(corner + offset, last), 0).rg;
        // Never 0: a surface that no texel shows takes what there is.
        float likeness = tolerance / (tolerance + abs(texel.g - z));
        float weight = part.x * part.y * max(likeness * likeness, 1e-12);
        sum += weight * texel.r;
        weights += weight;
    }
    return sum / weights;
}

// `color` without the occluded part of `ambient`, which is a share of it; never driven below 0.
vec3 ssao_darkened(vec3 color, vec3 ambient, float occluded) {
    if (occluded == 0.0) return color;
    vec3 lost = occluded * max(postfx_finite_or(ambient, 65504.0), 0.0);
    return color - min(lost, max(postfx_finite_or(color, 65504.0), 0.0));
}
