// Depth samples of every convention (standard, reversed, infinite; perspective, orthographic) to places in view space.
// depth is a raw sample of the "depth" attachment; no division by zero happens at the sky.

bool postfx_is_sky(float depth) {
    return depth == u_frame.sky_depth;
}

// 1 / (metres along the view axis); 0 at the sky.
float postfx_inverse_view_z(float depth) {
    if (postfx_is_sky(depth)) return 0.0;
    float affine = depth * u_frame.depth_affine.x + u_frame.depth_affine.y;
    return u_frame.orthographic ? 1.0 / affine : affine;
}

// Metres along the view axis; 3.4e38 at the sky.
float postfx_view_z(float depth) {
    if (postfx_is_sky(depth)) return 3.4e38;
    float affine = depth * u_frame.depth_affine.x + u_frame.depth_affine.y;
    return u_frame.orthographic ? affine : 1.0 / affine;
}

// View-space position [m] of the point seen at uv (0..1) with that depth. The camera looks down -z.
// Not for the sky: there is no point there.
vec3 postfx_view_position(vec2 uv, float depth) {
    float z = postfx_view_z(depth);
    vec2 plane = (2.0 * uv - 1.0 - u_frame.principal_point) * u_frame.half_extent;
    return vec3(u_frame.orthographic ? plane : plane * z, -z);
}

// Where the pixel's ray crosses the plane 1 m before the camera (perspective), or lies beside the axis (parallel) [m].
// `pixel` is of a target of the picture's size. With the axis in the picture's middle, mirrored pixels have mirrored
// values to the last bit, the centre 0.
vec2 postfx_view_plane(Pixel pixel) {
    vec2 from_axis = 2.0 * pixel.position - u_frame.size - u_frame.principal_point * u_frame.size;
    return from_axis * (u_frame.inverse_size * u_frame.half_extent);
}

// Unit vector from the camera towards the point seen at uv, in view space.
vec3 postfx_view_direction(vec2 uv) {
    if (u_frame.orthographic) return vec3(0.0, 0.0, -1.0);
    return normalize(vec3((2.0 * uv - 1.0 - u_frame.principal_point) * u_frame.half_extent, -1.0));
}
