#include "ssao_occlusion.glsl"

// Without knowing the ambient share: all light counts as ambient.
vec3 ssao_multiply(vec3 color, Pixel pixel, SsaoMultiplyParams params, sampler2D depth, sampler2D occlusion, sampler2D normal) {
    return ssao_darkened(color, color, params.strength * ssao_occlusion(pixel, params.radius, depth, occlusion, normal));
}
