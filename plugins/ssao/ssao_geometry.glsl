#include "ssao_distance.glsl"

// What the gather needs of one pixel per block: metres along the view axis, and the unit normal, 0 if it is unusable.
void ssao_geometry(Pixel pixel, SsaoGeometryParams params, sampler2D depth, sampler2D normal, out vec4 z,
                   out vec4 unit_normal) {
    ivec2 at = SSAO_BLOCK * pixel.index;
    z = vec4(ssao_distance(texelFetch(depth, at, 0).r));
    vec3 given = texelFetch(normal, at, 0).xyz;
    float squared = dot(given, given);
    bool usable = postfx_is_finite(squared) && squared > 0.01 && squared < 100.0;
    unit_normal = vec4(usable ? given * inversesqrt(squared) : vec3(0.0), 0.0);
}
