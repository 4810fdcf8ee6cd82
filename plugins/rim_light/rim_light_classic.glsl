#include "rim_light_surface.glsl"

// (d + s) / s with d from the view direction and the normal as it is: filtered and interpolated normals are shorter,
// which widens the rim, and surfaces whose normal points away are lit all over. params.slope is s.
vec3 rim_light_classic(vec3 color, Pixel pixel, RimLightClassicParams params, sampler2D normal) {
    vec3 n = rim_light_surface(pixel, normal);
    float d = dot(n, -normalize(rim_light_to_eye(pixel)));
    float share = clamp((d + params.slope) / params.slope, 0.0, 1.0);
    return rim_light_add(color, n == vec3(0.0) ? 0.0 : share, params.light);
}
