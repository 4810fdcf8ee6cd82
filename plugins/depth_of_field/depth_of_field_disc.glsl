// Part of the texel at that squared distance that a disc covers: 1 inside, then falling to 0 over about a texel,
// linear in the square so that the area is pi r^2 from r = 1 up. All in texels; radius at least 0.5.
float depth_of_field_disc(float radius, float squared) {
    return clamp(0.5 * radius + 0.5 - squared * (0.5 / radius), 0.0, 1.0);
}

// The gathers visit a lattice around their own texel: every texel; every second one, as on a checkerboard; or every
// fourth, nearly in hexagons: of every second row, by turns from an even and an odd column. What begins at -extent:
const int DEPTH_OF_FIELD_ROW_STEP = DEPTH_OF_FIELD_LATTICE == 4 ? 2 : 1;
const int DEPTH_OF_FIELD_COLUMN_STEP = DEPTH_OF_FIELD_LATTICE == 1 ? 1 : 2;

int depth_of_field_first_row(int extent) {
    return DEPTH_OF_FIELD_LATTICE == 4 ? (extent & 1) - extent : -extent;
}

int depth_of_field_first_column(int extent, int row) {
    if (DEPTH_OF_FIELD_LATTICE == 1) return -extent;
    int shift = DEPTH_OF_FIELD_LATTICE == 2 ? row : row / 2;
    return ((extent + shift) & 1) - extent;
}

// The same for a radius per colour channel, which axial aberration shifts, as shares of the disc's light (up to a
// common factor).
vec3 depth_of_field_light_discs(float radius, vec3 shift, float squared) {
    vec3 radii = max(radius + shift, 0.5);
    vec3 slope = 0.5 / radii;
    return clamp(0.5 * radii + 0.5 - squared * slope, 0.0, 1.0) * (slope * slope);
}
