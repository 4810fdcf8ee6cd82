#include <postfx/census.glsl>

// Rays begin at the eye; those of parallel views at the near plane, which makes them shorter.
vec2 fog_nearer(DepthCensus depth, FogNearerParams params) {
    return vec2(depth.farthest * params.longest_ray, params.start);
}
