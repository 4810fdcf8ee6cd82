#include "fog_path.glsl"

// Height fog in a form that treats both ends alike: with y the lower one,
//     thickness = density(y) * length * mean of e^-t over t = 0..falloff * |rise|.
// The argument is never negative, so nothing overflows, and camera and point can be exchanged.
vec3 fog(vec3 color, Pixel pixel, FogParams params, sampler2D depth) {
    FogPath path = fog_path(pixel, texelFetch(depth, pixel.index, 0).r, params.start, params.base_height);
    float thickness = 0.0;
    if (!path.to_sky) {
        float rise = path.slope * path.length;
        float density = fog_density(path.height + min(rise, 0.0), params.density, params.height_falloff);
        thickness = density * path.length * fog_mean_exp(params.height_falloff * abs(rise));
    } else if (params.sky) {
        thickness = fog_thickness_of_sky(path, params.density, params.height_falloff);
    }
    return fog_blend(color, thickness, params.color, params.max_opacity);
}
