// Texel t of the images of one texel per block stands for the pixel at SSAO_BLOCK * t: a real pixel, so that no place
// is ever between two surfaces.

// Step from a texel to the next, and where texel 0 is: in units of the plane at 1 m (perspective), in metres
// (orthographic).
vec2 ssao_plane_step() {
    return 2.0 * float(SSAO_BLOCK) * u_frame.inverse_size * u_frame.half_extent;
}
vec2 ssao_plane_start() {
    return (u_frame.inverse_size - 1.0 - u_frame.principal_point) * u_frame.half_extent;
}

// View-space position [m].
vec3 ssao_place(vec2 plane, float z) {
    return vec3(plane * (u_frame.orthographic ? 1.0 : z), -z);
}
