// Part of the texel at that distance that a disc covers: 1 inside, then falling to 0 over DEPTH_OF_FIELD_EDGE texels.
// All in texels; radius at least 0.5.
vec4 depth_of_field_disc(vec4 radius, vec4 distance) {
    return clamp((radius - distance) * (1.0 / DEPTH_OF_FIELD_EDGE) + 0.5, 0.0, 1.0);
}

float depth_of_field_disc(float radius, float distance) {
    return depth_of_field_disc(vec4(radius), vec4(distance)).x;
}

// How far a disc reaches, texels.
float depth_of_field_extent(float radius) {
    return radius + 0.5 * DEPTH_OF_FIELD_EDGE;
}

// Columns that a disc of that extent has in a row, on either side.
int depth_of_field_columns(float extent, float row) {
    return int(sqrt(max(extent * extent - row * row, 0.0)));
}
