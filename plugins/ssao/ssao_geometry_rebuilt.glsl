#include "ssao_distance.glsl"

// What is affine on the screen where the scene is a plane: 1/z (perspective) or z (orthographic). 0 where there is
// nothing in a perspective view: a plane at infinity.
float ssao_affine(float depth) {
    float z = ssao_distance(depth);
    if (u_frame.orthographic) return z;
    return z == SSAO_NOTHING ? 0.0 : 1.0 / z;
}

// Slope per pixel from the side whose two pixels continue best to this one: the other may cross an edge.
float ssao_slope(sampler2D depth, ivec2 at, ivec2 side, float here) {
    ivec2 last = textureSize(depth, 0) - 1;
    float slope = 0.0, smallest = 3e38;
    for (int turn = -1; turn <= 1; turn += 2) {
        ivec2 far = at + 2 * turn * side;
        if (any(lessThan(far, ivec2(0))) || any(greaterThan(far, last))) continue;
        float first = ssao_affine(texelFetch(depth, at + turn * side, 0).r);
        float second = ssao_affine(texelFetch(depth, far, 0).r);
        float bend = abs(here - 2.0 * first + second);
        if (bend < smallest) {
            smallest = bend;
            slope = float(turn) * (first - here);
        }
    }
    return slope;
}

// As ssao_geometry, with the normal of the plane through the pixel and its neighbours.
void ssao_geometry_rebuilt(Pixel pixel, SsaoGeometryRebuiltParams params, sampler2D depth, out vec4 z,
                           out vec4 unit_normal) {
    ivec2 at = SSAO_BLOCK * pixel.index;
    float raw = texelFetch(depth, at, 0).r;
    float here = ssao_affine(raw);
    vec2 plane_per_pixel = 2.0 * u_frame.inverse_size * u_frame.half_extent;
    vec2 plane = (vec2(at) + 0.5) * plane_per_pixel - u_frame.half_extent;
    vec2 slope =
        vec2(ssao_slope(depth, at, ivec2(1, 0), here), ssao_slope(depth, at, ivec2(0, 1), here)) / plane_per_pixel;
    // n . (plane z, -z) = -1 gives 1/z = slope . plane + constant (perspective); z = slope . plane + constant else.
    vec3 normal = u_frame.orthographic ? vec3(slope, 1.0) : vec3(-slope, here - dot(slope, plane));
    float largest = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
    z = vec4(ssao_distance(raw));
    bool usable = z.r < SSAO_NOTHING && postfx_is_finite(largest) && largest > 0.0;
    unit_normal = vec4(usable ? normalize(normal / largest) : vec3(0.0), 0.0);
}
