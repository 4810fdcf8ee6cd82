#include "ssao_distance.glsl"

// What is affine on the screen where the scene is a plane: 1/z (perspective) or z (orthographic).
float ssao_affine(float z) {
    return u_frame.orthographic ? z : 1.0 / z;
}

// Metres along the view axis, nothing outside the picture.
float ssao_distance_at(sampler2D depth, ivec2 at) {
    ivec2 last = textureSize(depth, 0) - 1;
    bool outside = any(lessThan(at, ivec2(0))) || any(greaterThan(at, last));
    return outside ? SSAO_NOTHING : ssao_distance(texelFetch(depth, clamp(at, ivec2(0), last), 0).r);
}

// Slope per pixel from the side whose two pixels continue best to this one: the other may cross an edge. A side that
// shows only one pixel of surface comes last; 0 if there is none at all.
float ssao_slope(sampler2D depth, ivec2 at, ivec2 side, float here) {
    float slope = 0.0, smallest = 3e38;
    for (int turn = -1; turn <= 1; turn += 2) {
        float z_near = ssao_distance_at(depth, at + turn * side);
        float z_far = ssao_distance_at(depth, at + 2 * turn * side);
        if (z_near == SSAO_NOTHING) continue;
        float rise = ssao_affine(z_near) - here;
        float bend = z_far == SSAO_NOTHING ? 1e38 : abs(ssao_affine(z_far) - here - 2.0 * rise);
        if (bend < smallest) {
            smallest = bend;
            slope = float(turn) * rise;
        }
    }
    return slope;
}

// As ssao_geometry, with the normal of the plane through the pixel and its neighbours.
void ssao_geometry_rebuilt(Pixel pixel, SsaoGeometryRebuiltParams params, sampler2D depth, out vec4 z,
                           out vec4 unit_normal) {
    ivec2 at = SSAO_BLOCK * pixel.index;
    z = vec4(ssao_distance(texelFetch(depth, at, 0).r));
    float here = ssao_affine(z.r);
    vec2 plane_per_pixel = 2.0 * u_frame.inverse_size * u_frame.half_extent;
    vec2 plane = (vec2(at) + 0.5) * plane_per_pixel - u_frame.half_extent * (1.0 + u_frame.principal_point);
    vec2 slope =
        vec2(ssao_slope(depth, at, ivec2(1, 0), here), ssao_slope(depth, at, ivec2(0, 1), here)) / plane_per_pixel;
    // n . (plane z, -z) = -1 gives 1/z = slope . plane + constant (perspective); z = slope . plane + constant else.
    vec3 normal = u_frame.orthographic ? vec3(slope, 1.0) : vec3(-slope, here - dot(slope, plane));
    float largest = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
    bool usable = z.r < SSAO_NOTHING && postfx_is_finite(largest) && largest > 0.0;
    unit_normal = vec4(usable ? normalize(normal / largest) : vec3(0.0), 0.0);
}
