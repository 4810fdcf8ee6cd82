#include <postfx/depth.glsl>
#include <postfx/numeric.glsl>

// On a plane, 1/z is affine in the picture's coordinates (z itself for parallel rays): its differences give the
// plane's normal exactly, however steep. Positive; 0 for what belongs to no plane: the sky and outside the picture.
float rim_light_affine(sampler2D depth, ivec2 index) {
    ivec2 size = textureSize(depth, 0);
    if (any(lessThan(index, ivec2(0))) || any(greaterThanEqual(index, size))) return 0.0;
    float raw = texelFetch(depth, index, 0).r;
    if (postfx_is_sky(raw)) return 0.0;
    return u_frame.orthographic ? postfx_view_z(raw) : postfx_inverse_view_z(raw);
}

// Difference per pixel along `direction`, from the side whose two pixels lie in one plane with this one: so a
// silhouette or crease keeps its own surface's normal. 0 if neither side has anything.
float rim_light_difference(sampler2D depth, ivec2 index, float here, ivec2 direction) {
    float side[2], misfit[2];
    for (int i = 0; i < 2; ++i) {
        ivec2 away = i == 0 ? -direction : direction;
        float first = rim_light_affine(depth, index + away), second = rim_light_affine(depth, index + 2 * away);
        side[i] = first > 0.0 ? (i == 0 ? here - first : first - here) : 0.0;
        float expected = second > 0.0 ? 2.0 * first - second : first;
        misfit[i] = first > 0.0 ? abs(here - expected) : 3e38;
    }
    return misfit[0] < misfit[1] ? side[0] : side[1];
}

// Unit normal in view space, towards the eye; 0 at the sky and where depth is no distance.
vec4 rim_light_normal(Pixel pixel, RimLightNormalParams params, sampler2D depth) {
    float here = rim_light_affine(depth, pixel.index);
    if (!postfx_is_finite(here) || here <= 0.0) return vec4(0.0);
    vec2 difference = vec2(rim_light_difference(depth, pixel.index, here, ivec2(1, 0)),
                           rim_light_difference(depth, pixel.index, here, ivec2(0, 1)));
    vec2 gradient = difference * vec2(pixel.size) / (2.0 * u_frame.half_extent);
    vec3 normal = vec3(gradient, 1.0);
    if (!u_frame.orthographic) {
        gradient /= here;
        normal = vec3(-gradient, 1.0 - dot(gradient, postfx_view_plane(pixel)));
    }
    float squared = dot(normal, normal);
    return postfx_is_finite(squared) ? vec4(normal * inversesqrt(squared), 0.0) : vec4(0.0);
}
