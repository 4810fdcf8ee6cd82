#include <postfx/depth.glsl>
#include <postfx/numeric.glsl>

// View-space normal of what is seen, of any length from 1e-6 to 1e6; 0 where nothing is seen, and for what gives no
// direction (NaN, zero, denormal, infinite).
vec3 rim_light_surface(Pixel pixel, sampler2D normal) {
    vec3 n = texelFetch(normal, pixel.index, 0).xyz;
    float squared = dot(n, n);
    return postfx_is_finite(squared) && squared >= 1e-12 && squared <= 1e12 ? n : vec3(0.0);
}

// From the surface to the eye, not unit; parallel rays all have the same.
vec3 rim_light_to_eye(Pixel pixel) {
    return RIM_LIGHT_PARALLEL != 0 ? vec3(0.0, 0.0, 1.0) : vec3(-postfx_view_plane(pixel), 1.0);
}

// No light is lifted over the largest half float; where there is no share of it, the light keeps its bits.
vec3 rim_light_add(vec3 color, float share, vec3 light) {
    return share > 0.0 ? color + min(share * light, max(POSTFX_BRIGHTEST - color, 0.0)) : color;
}
