#include "ssao_distance.glsl"
#include "ssao_place.glsl"

// Mean over 3x3 texels, which look along different slices. Texels off this texel's tangent plane by a quarter of the
// radius are another surface; those whose occlusion is not known (-1) count for nothing and stay so.
vec4 ssao_denoise(Pixel pixel, SsaoDenoiseParams params, sampler2D occlusion, sampler2D normals) {
    vec2 own = texelFetch(occlusion, pixel.index, 0).rg;
    vec3 normal = texelFetch(normals, pixel.index, 0).xyz;
    if (own.g == SSAO_NOTHING || normal == vec3(0.0)) return vec4(own, 0.0, 0.0);
    ivec2 last = textureSize(occlusion, 0) - 1;
    vec2 plane_step = ssao_plane_step(), plane_start = ssao_plane_start();
    float height = dot(normal, ssao_place(vec2(pixel.index) * plane_step + plane_start, own.g));
    float sharpness = 4.0 / params.radius;
    float sum = 0.0, weights = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = clamp(pixel.index + ivec2(x, y), ivec2(0), last);
            vec2 texel = texelFetch(occlusion, at, 0).rg;
            float off = dot(normal, ssao_place(vec2(at) * plane_step + plane_start, texel.g)) - height;
            float weight = texel.r < 0.0 ? 0.0 : max(1.0 - abs(off) * sharpness, 0.0);
            sum += weight * texel.r;
            weights += weight;
        }
    }
    return vec4(clamp(sum / weights, 0.0, 1.0), own.g, 0.0, 0.0);
}
