// Part of the texel at that squared distance that a disc covers: 1 inside, then falling to 0 over about a texel,
// linear in the square so that the area is pi r^2 from r = 1 up. All in texels; radius at least 0.5.
float depth_of_field_disc(float radius, float squared) {
    return clamp(0.5 * radius + 0.5 - squared * (0.5 / radius), 0.0, 1.0);
}

// The gathers visit a lattice around their own texel: every texel (1); every second one, as on a checkerboard (2); or
// every fourth, nearly in hexagons (4): of every second row, by turns from an even and an odd column.
int depth_of_field_row_step(int lattice) {
    return lattice == 4 ? 2 : 1;
}

int depth_of_field_column_step(int lattice) {
    return lattice == 1 ? 1 : 2;
}

// What begins at -extent:
int depth_of_field_first_row(int lattice, int extent) {
    return lattice == 4 ? (extent & 1) - extent : -extent;
}

int depth_of_field_first_column(int lattice, int extent, int row) {
    if (lattice == 1) return -extent;
    int shift = lattice == 2 ? row : row / 2;
    return ((extent + shift) & 1) - extent;
}
