#include "depth_of_field_disc.glsl"

// Sum of a disc's weights, for radii from 0.5 to the largest: what makes full coverage 1.
vec4 depth_of_field_discs(Pixel pixel, DepthOfFieldDiscsParams params) {
    float part = float(pixel.index.x) / float(pixel.size.x - 1);
    float radius = 0.5 + part * (params.largest_radius - 0.5);
    float extent = depth_of_field_extent(radius);
    int rows = int(extent);
    float sum = 0.0;
    for (int y = -rows; y <= rows; ++y) {
        int columns = depth_of_field_columns(extent, float(y));
        for (int x = -columns; x <= columns; ++x)
            sum += depth_of_field_disc(radius, length(vec2(x, y)));
    }
    return vec4(sum, 0.0, 0.0, 0.0);
}
