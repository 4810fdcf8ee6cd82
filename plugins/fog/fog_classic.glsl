#include "fog_path.glsl"

// Constant density and the distance along the view axis instead of along the ray.
vec3 fog_classic(vec3 color, Pixel pixel, FogClassicParams params, sampler2D depth) {
    float raw = texelFetch(depth, pixel.index, 0).r;
    float thickness = params.density * max(fog_view_distance(raw) - params.start, 0.0);
    if (FOG_SKY == 0 && postfx_is_sky(raw)) thickness = 0.0;
    return fog_blend(color, thickness, params.color, params.max_opacity);
}
