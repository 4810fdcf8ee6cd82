#include "fog_path.glsl"

// Height fog in a form that treats both ends alike: with y the lower one,
//     thickness = density(y) * length * mean of e^-t over t = 0..falloff * |rise|.
// The argument is never negative, so nothing overflows, and camera and point can be exchanged.
vec3 fog(vec3 color, Pixel pixel, FogParams params, sampler2D depth) {
    float raw = texelFetch(depth, pixel.index, 0).r;
    FogPath path = fog_path(pixel, raw, params.start, params.base_height);
    float density = fog_density(path.height + min(path.rise, 0.0), params.density, params.height_falloff);
    float thickness = density * path.distance * fog_mean_exp(params.height_falloff * abs(path.rise));
    if (FOG_SKY == 0 && postfx_is_sky(raw)) thickness = 0.0;
    return fog_blend(color, thickness, params.color, params.max_opacity);
}
