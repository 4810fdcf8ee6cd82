#include "ssao_distance.glsl"
#include "ssao_normal.glsl"

// What the gather needs of one pixel per block: metres along the view axis, and the unit normal, 0 if it is unusable.
void ssao_geometry(Pixel pixel, SsaoGeometryParams params, sampler2D depth, sampler2D normal, out vec4 z,
                   out vec4 unit_normal) {
    ivec2 at = SSAO_BLOCK * pixel.index;
    z = vec4(ssao_distance(texelFetch(depth, at, 0).r));
    unit_normal = vec4(ssao_unit_normal(texelFetch(normal, at, 0).xyz), 0.0);
}
