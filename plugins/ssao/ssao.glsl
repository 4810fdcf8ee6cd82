#include "ssao_occlusion.glsl"

// Takes the occluded part of the ambient share out of the light.
vec3 ssao(vec3 color, Pixel pixel, SsaoParams params, sampler2D depth, sampler2D occlusion, sampler2D normal,
          sampler2D ambient) {
    float occluded = params.strength * ssao_occlusion(pixel, params.radius, depth, occlusion, normal);
    return ssao_darkened(color, texelFetch(ambient, pixel.index, 0).rgb, occluded);
}
