#include "ssao_distance.glsl"
#include "ssao_place.glsl"

// Mean over 4x4 texels, which look along 16 different slices: the window has 5x5 with its outer texels counted half, so
// that it is centred and every slice counts once. Texels off this texel's tangent plane by a quarter of the radius are
// another surface.
vec4 ssao_denoise(Pixel pixel, SsaoDenoiseParams params, sampler2D gathered, sampler2D normals) {
    vec2 own = texelFetch(gathered, pixel.index, 0).rg;
    vec3 normal = texelFetch(normals, pixel.index, 0).xyz;
    if (own.g == SSAO_NOTHING || normal == vec3(0.0)) return vec4(0.0, own.g, 0.0, 0.0);
    ivec2 last = textureSize(gathered, 0) - 1;
    vec2 plane_step = ssao_plane_step(), plane_start = ssao_plane_start();
    float height = dot(normal, ssao_place(vec2(pixel.index) * plane_step + plane_start, own.g));
    float sharpness = 4.0 / params.radius;
    float sum = 0.0, weights = 0.0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 at = clamp(pixel.index + ivec2(x, y), ivec2(0), last);
            vec2 texel = texelFetch(gathered, at, 0).rg;
            float off = dot(normal, ssao_place(vec2(at) * plane_step + plane_start, texel.g)) - height;
            float weight = clamp(1.0 - abs(off) * sharpness, 0.0, 1.0);
            weight *= (abs(x) == 2 ? 0.5 : 1.0) * (abs(y) == 2 ? 0.5 : 1.0);
            sum += weight * texel.r;
            weights += weight;
        }
    }
    return vec4(clamp(sum / weights, 0.0, 1.0), own.g, 0.0, 0.0);
}
