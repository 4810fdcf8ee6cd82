#include <postfx/census.glsl>

// circle: its scale [px], the focus distance [m], the sky's circle, the largest shift by axial aberration.
float depth_of_field_circle_at(float z, vec4 circle) {
    return abs(circle.x * (DEPTH_OF_FIELD_PARALLEL == 1 ? z / circle.y - 1.0 : 1.0 - circle.y / z));
}

vec2 depth_of_field_sharp(DepthCensus depth, DepthOfFieldSharpParams params) {
    float largest = depth.has_sky ? abs(params.circle.z) : 0.0;
    if (depth.has_surface) {
        float nearest = depth_of_field_circle_at(depth.nearest, params.circle);
        float farthest = depth_of_field_circle_at(depth.farthest, params.circle);
        largest = nearest <= largest ? largest : nearest; // a NaN stays
        largest = farthest <= largest ? largest : farthest;
    }
    return vec2(largest + params.circle.w, params.limit);
}
