#include "fog_blend.glsl"
#include <postfx/depth.glsl>
#include <postfx/numeric.glsl>

// The part of a pixel's ray that runs through fog.
struct FogPath {
    float height; // of its beginning above the base height [m]
    float slope;  // rise per metre
    float length; // [m], at most some 1e15
    bool to_sky;  // length has no meaning: it does not end
};

// Metres along the view axis from where rays begin (the eye; the near plane of parallel rays), within 0..1e12: so
// nothing below overflows. A sample that is no distance (NaN, behind the camera) is taken as 0, which gets no fog.
float fog_view_distance(float depth) {
    float z = postfx_finite_or(postfx_view_z(depth), 1e12);
    return clamp(u_frame.orthographic ? z - u_frame.near_plane : z, 0.0, 1e12);
}

FogPath fog_path(Pixel pixel, float depth, float start, float base_height) {
    vec2 plane = postfx_view_plane(pixel);
    vec3 ray = u_frame.orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0);
    vec3 origin = u_frame.orthographic ? vec3(plane, -u_frame.near_plane) : vec3(0.0);
    vec3 up = vec3(u_frame.view_to_world[0].y, u_frame.view_to_world[1].y, u_frame.view_to_world[2].y);
    float per_view_distance = length(ray);
    float distance = fog_view_distance(depth) * per_view_distance;
    float begin = min(start, distance);
    // The camera's height above the base first: their difference is exact where both are large and close.
    float eye = u_frame.view_to_world[3].y - base_height;
    FogPath path;
    path.slope = dot(up, ray) / per_view_distance;
    path.height = eye + dot(up, origin) + path.slope * begin;
    path.length = distance - begin;
    path.to_sky = postfx_is_sky(depth);
    return path;
}

// Density at a height above the base [1/m]. The exponent's upper bound keeps products with any length finite: with a
// density of 1e-9 fog is opaque within a millionth of a metre there.
float fog_density(float height, float density, float falloff) {
    return density * exp(clamp(-falloff * height, -87.0, 50.0));
}

// Optical thickness from there to infinity: none is left high up, and level or downward rays never leave the fog.
float fog_thickness_of_sky(FogPath path, float density, float falloff) {
    float at_beginning = fog_density(path.height, density, falloff);
    float falloff_along = falloff * path.slope;
    return at_beginning >= FOG_OPAQUE * falloff_along ? FOG_OPAQUE : at_beginning / falloff_along;
}
