#include "ssao_occlusion.glsl"

// The visibility alone.
vec3 ssao_view(vec3 color, Pixel pixel, SsaoViewParams params, sampler2D depth, sampler2D occlusion, sampler2D normal) {
    return vec3(1.0 - params.strength * ssao_occlusion(pixel, params.radius, depth, occlusion, normal));
}
