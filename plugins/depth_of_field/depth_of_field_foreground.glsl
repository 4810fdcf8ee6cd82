#include "depth_of_field_disc.glsl"

// The foreground's discs that cover this texel: colour times coverage, coverage. Outside its silhouette too.
vec4 depth_of_field_foreground(Pixel pixel, DepthOfFieldForegroundParams params, sampler2D layer, sampler2D thickness,
                               sampler2D reach) {
    float radius = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).r;
    float outer = radius > 0.0 ? radius + 0.5 + (DEPTH_OF_FIELD_AXIAL == 1 ? params.axial_reach : 0.0) : 0.0;
    ivec2 last = textureSize(layer, 0) - 1;
    int rows = int(outer);
    vec4 sum = vec4(0.0);
    vec3 coloured_sum = vec3(0.0), coloured_weights = vec3(0.0);
    for (int y = depth_of_field_first_row(rows); y <= rows; y += DEPTH_OF_FIELD_ROW_STEP) {
        float row_squared = float(y) * float(y);
        int columns = int(sqrt(outer * outer - row_squared));
        int row = clamp(pixel.index.y + y, 0, last.y);
        for (int x = depth_of_field_first_column(columns, y); x <= columns; x += DEPTH_OF_FIELD_COLUMN_STEP) {
            ivec2 at = ivec2(clamp(pixel.index.x + x, 0, last.x), row);
            vec4 texel = texelFetch(layer, at, 0);
            float thick = texelFetch(thickness, at, 0).r;
            float squared = float(x) * float(x) + row_squared;
            sum += thick * depth_of_field_disc(max(texel.a, 0.5), squared) * vec4(texel.rgb, 1.0);
            if (DEPTH_OF_FIELD_AXIAL == 1) {
                vec3 coloured = thick * depth_of_field_light_discs(texel.a, params.axial_shift, squared);
                coloured_sum += coloured * texel.rgb;
                coloured_weights += coloured;
            }
        }
    }
    if (DEPTH_OF_FIELD_AXIAL == 1) {
        // The silhouette is green's for all channels: a coverage of each would take another image.
        bvec3 reached = greaterThan(coloured_weights, vec3(0.0));
        sum.rgb = mix(sum.rgb, coloured_sum / max(coloured_weights, 1e-30) * sum.a, reached);
    }
    return sum / max(1.0, sum.a); // discs that differ may overlap
}
