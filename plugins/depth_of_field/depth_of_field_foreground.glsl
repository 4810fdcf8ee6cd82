#include "depth_of_field_disc.glsl"
#include "depth_of_field_sum.glsl"

// Foreground that covers a texel.
struct DepthOfFieldCover {
    vec4 light;              // colour times coverage, coverage
    DepthOfFieldSum colours; // by each colour's own disc, with axial aberration
    float radii;             // radius times coverage
};

// What covers a texel, weighted by clamp(radius * slope + offset, 0, 1). Coverage may exceed 1 where discs that
// differ overlap.
DepthOfFieldCover depth_of_field_cover(Pixel pixel, float outer, float slope, float offset, vec3 shift,
                                       sampler2D layer, sampler2D thickness) {
    DepthOfFieldSum none = DepthOfFieldSum(vec3(0.0), vec3(0.0));
    DepthOfFieldCover cover = DepthOfFieldCover(vec4(0.0), none, 0.0);
    ivec2 last = textureSize(layer, 0) - 1;
    int lattice = DEPTH_OF_FIELD_LATTICE;
    int rows = int(outer);
    for (int y = depth_of_field_first_row(lattice, rows); y <= rows; y += depth_of_field_row_step(lattice)) {
        float row_squared = float(y) * float(y);
        int columns = int(sqrt(max(outer * outer - row_squared, 0.0)));
        int row = clamp(pixel.index.y + y, 0, last.y);
        int column_step = depth_of_field_column_step(lattice);
        for (int x = depth_of_field_first_column(lattice, columns, y); x <= columns; x += column_step) {
            ivec2 at = ivec2(clamp(pixel.index.x + x, 0, last.x), row);
            vec4 texel = texelFetch(layer, at, 0);
            float thick = texelFetch(thickness, at, 0).r * clamp(texel.a * slope + offset, 0.0, 1.0);
            float squared = float(x) * float(x) + row_squared;
            float coverage = thick * depth_of_field_disc(max(texel.a, 0.5), squared);
            cover.light += coverage * vec4(texel.rgb, 1.0);
            cover.radii += coverage * texel.a;
            if (DEPTH_OF_FIELD_AXIAL == 1) depth_of_field_add(cover.colours, texel.rgb, thick, texel.a, shift, squared);
        }
    }
    return cover;
}

// Its colour times coverage, coverage: the near part by one factor, the rest by another.
vec4 depth_of_field_covered(DepthOfFieldCover all, DepthOfFieldCover near, float near_factor, float far_factor) {
    vec4 sum = near_factor * near.light + far_factor * (all.light - near.light);
    if (DEPTH_OF_FIELD_AXIAL == 1) {
        // The silhouette is green's for all channels: a coverage of each would take another image.
        vec3 light = near_factor * near.colours.light + far_factor * (all.colours.light - near.colours.light);
        vec3 weights = near_factor * near.colours.weights + far_factor * (all.colours.weights - near.colours.weights);
        sum.rgb = mix(sum.rgb, light / max(weights, 1e-30) * sum.a, greaterThan(weights, vec3(0.0)));
    }
    return sum;
}

// The foreground's discs that cover this texel: colour times coverage, coverage. Outside its silhouette too. Where
// they cover it more than once, the nearer ones hide the farther: those of radii above the mean count first.
vec4 depth_of_field_foreground(Pixel pixel, DepthOfFieldForegroundParams params, sampler2D layer, sampler2D thickness,
                               sampler2D reach) {
    float radius = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).r;
    float outer = radius > 0.0 ? radius + 0.5 + (DEPTH_OF_FIELD_AXIAL == 1 ? params.axial_reach : 0.0) : -1.0;
    DepthOfFieldCover all = depth_of_field_cover(pixel, outer, 0.0, 1.0, params.axial_shift, layer, thickness);
    // Slopes add up to about 1: nothing is hidden there, and nothing has to be gathered again.
    float excess = clamp(25.0 * (all.light.a - 1.01), 0.0, 1.0);
    float per_mean = 2.0 * all.light.a / max(all.radii, 1e-30);
    DepthOfFieldCover near = depth_of_field_cover(pixel, excess > 0.0 ? outer : -1.0, per_mean, -1.5,
                                                  params.axial_shift, layer, thickness);
    float together = 1.0 / max(all.light.a, 1.0);
    float near_factor = 1.0 / max(near.light.a, 1.0);
    float far_factor = max(1.0 - near.light.a, 0.0) / max(all.light.a - near.light.a, 1e-30);
    return depth_of_field_covered(all, near, mix(together, near_factor, excess), mix(together, far_factor, excess));
}
