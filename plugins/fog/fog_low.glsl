#include "fog_path.glsl"

// Height fog as it is usually written: density where the ray begins, times the mean of e^-t over t = 0..x, which is
// replaced by 1 near 0. From high above, density is 0 and the mean infinite: both are cut off, and the fog is lost.
// The other bounds keep the product finite.
vec3 fog_low(vec3 color, Pixel pixel, FogLowParams params, sampler2D depth) {
    float raw = texelFetch(depth, pixel.index, 0).r;
    FogPath path = fog_path(pixel, raw, params.start, params.base_height);
    float x = params.height_falloff * path.rise;
    float mean = abs(x) > 0.00125 ? (1.0 - exp(min(-x, 30.0))) / x : 1.0;
    float density = fog_density(path.height, params.density, params.height_falloff);
    float thickness = min(density, 1e9) * min(path.length * mean, 1e27);
    if (FOG_SKY == 0 && postfx_is_sky(raw)) thickness = 0.0;
    return fog_blend(color, thickness, params.color, params.max_opacity);
}
