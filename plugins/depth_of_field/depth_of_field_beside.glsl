// The texels around one, in turns of opposite ones: beside, above, at the corners.
ivec2 depth_of_field_beside(int i) {
    ivec2 offset = i < 2 ? ivec2(1, 0) : i < 4 ? ivec2(0, 1) : i < 6 ? ivec2(1, 1) : ivec2(1, -1);
    return offset * (1 - 2 * (i & 1));
}

// Joins the parts of a lattice: a texel saw only every second or fourth neighbour, those beside it the others. Every
// second: the four beside it saw what it did not, and together get the same weight as it. Every fourth: a tent two
// texels wide gives each part the same weight. So every disc becomes even.
int depth_of_field_joined(int lattice) {
    return lattice == 2 ? 4 : lattice == 4 ? 8 : 0;
}

float depth_of_field_own_weight(int joined) {
    return joined == 8 ? 0.25 : joined == 4 ? 0.5 : 1.0;
}

float depth_of_field_weight_beside(int i) {
    return i < 4 ? 0.125 : 0.0625;
}
