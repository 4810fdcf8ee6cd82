#include "fog_blend.glsl"
#include <postfx/depth.glsl>

// The part of a pixel's ray that runs through fog [m].
struct FogPath {
    float height; // of its beginning above the base height
    float rise;   // from there to its end
    float distance;
};

// Metres along the view axis from where rays begin (the eye; the near plane of parallel rays) to at most 1e20, where
// the sky is taken to be: so nothing below overflows. What is no distance (NaN, behind the camera) is 0: no fog.
float fog_view_distance(float depth) {
    float z = postfx_view_z(depth);
    if (FOG_PARALLEL != 0) z -= u_frame.near_plane;
    return floatBitsToUint(z) <= 0x7f800000u ? min(z, 1e20) : 0.0; // the bits of 0 to +infinity
}

FogPath fog_path(Pixel pixel, float depth, float start, float base_height) {
    vec2 plane = postfx_view_plane(pixel);
    vec3 up = vec3(u_frame.view_to_world[0].y, u_frame.view_to_world[1].y, u_frame.view_to_world[2].y);
    float view_distance = fog_view_distance(depth);
    // The camera's height above the base first: their difference is exact where both are large and close.
    FogPath path;
    path.height = u_frame.view_to_world[3].y - base_height;
    if (FOG_PARALLEL != 0) {
        path.height += dot(up, vec3(plane, -u_frame.near_plane));
        path.rise = -up.z * view_distance;
        path.distance = view_distance;
    } else {
        vec3 ray = vec3(plane, -1.0);
        path.rise = dot(up, ray) * view_distance;
        path.distance = length(ray) * view_distance;
    }
    if (FOG_HAS_START != 0) {
        float clear = min(start, path.distance);
        float share = path.distance > 0.0 ? clear / path.distance : 0.0;
        path.height += share * path.rise;
        path.rise -= share * path.rise;
        path.distance -= clear;
    }
    return path;
}

// Density at a height above the base [1/m]. The exponent's upper bound keeps products with any length finite: with a
// density of 1e-9 fog is opaque within a tenth of a metre there.
float fog_density(float height, float density, float falloff) {
    return density * exp(clamp(-falloff * height, -87.0, 30.0));
}
