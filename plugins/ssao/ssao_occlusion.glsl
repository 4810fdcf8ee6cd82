#include "ssao_distance.glsl"
#include "ssao_normal.glsl"

// A pixel's occlusion, from the texels around it that are of its own surface. Where the texels don't know each pixel's
// normal (SSAO_CHECKS_NORMAL), it is looked at here: an unusable one leaves its pixel open.
float ssao_occlusion(Pixel pixel, float radius, sampler2D depth, sampler2D occlusion, sampler2D normal) {
    if (SSAO_CHECKS_NORMAL == 1 && ssao_unit_normal(texelFetch(normal, pixel.index, 0).xyz) == vec3(0.0)) return 0.0;
    if (SSAO_BLOCK == 1) return clamp(texelFetch(occlusion, pixel.index, 0).r, 0.0, 1.0);
    float z = ssao_distance(texelFetch(depth, pixel.index, 0).r);
    if (z == SSAO_NOTHING) return 0.0;
    vec2 place = vec2(pixel.index) / float(SSAO_BLOCK), corner = floor(place), fraction = place - corner;
    vec2 between = (corner + 1.0) / vec2(textureSize(occlusion, 0));
    vec4 occluded = textureGather(occlusion, between, 0); // the texels at corner + (0,1), (1,1), (1,0), (0,0)
    vec4 z_texels = textureGather(occlusion, between, 1);
    vec4 part = vec2(1.0 - fraction.x, fraction.x).xyyx * vec2(fraction.y, 1.0 - fraction.y).xxyy;
    // Never 0: a surface that no texel shows takes what there is.
    vec4 weight = part * max(1.0 - abs(z_texels - z) * (4.0 / radius), 1e-4);
    weight = mix(weight, vec4(0.0), lessThan(occluded, vec4(0.0))); // not known there
    float sum = dot(weight, vec4(1.0));
    return sum > 0.0 ? dot(weight, occluded) / sum : 0.0;
}

// `color` without the occluded part of `ambient`, which is a share of it; never driven below 0. An ambient share that
// is not finite means nothing.
vec3 ssao_darkened(vec3 color, vec3 ambient, float occluded) {
    bool usable = postfx_is_finite(ambient.r + ambient.g + ambient.b);
    if (occluded == 0.0 || !usable) return color;
    return color - clamp(occluded * ambient, vec3(0.0), max(color, 0.0));
}
