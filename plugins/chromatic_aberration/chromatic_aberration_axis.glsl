// Where the optical axis lies, about which a lens magnifies: in texture coordinates.
vec2 chromatic_aberration_axis() {
    return 0.5 + 0.5 * u_frame.principal_point;
}
