#include "depth_of_field_disc.glsl"

// Sum of a disc's weights over the lattice, for radii from 0.5 to the largest: what makes full coverage 1.
vec4 depth_of_field_discs(Pixel pixel, DepthOfFieldDiscsParams params) {
    float part = float(pixel.index.x) / float(pixel.size.x - 1);
    float radius = 0.5 + part * (params.largest_radius - 0.5);
    float outer = radius + 0.5;
    int rows = int(outer);
    float sum = 0.0;
    for (int y = depth_of_field_first_row(DEPTH_OF_FIELD_LATTICE, rows); y <= rows; y += depth_of_field_row_step(DEPTH_OF_FIELD_LATTICE)) {
        int columns = int(sqrt(outer * outer - float(y * y)));
        for (int x = depth_of_field_first_column(DEPTH_OF_FIELD_LATTICE, columns, y); x <= columns; x += depth_of_field_column_step(DEPTH_OF_FIELD_LATTICE)) {
            sum += depth_of_field_disc(radius, float(x * x + y * y));
        }
    }
    return vec4(sum, 0.0, 0.0, 0.0);
}
