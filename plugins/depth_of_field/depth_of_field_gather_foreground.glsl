#include "depth_of_field_square.glsl"

// Foreground that covers the texels of a square.
struct DepthOfFieldCover {
    vec4 coverage, radii;       // radius times coverage
    vec4 red, green, blue;      // times coverage
    DepthOfFieldSquare colours; // by each colour's own disc, with axial aberration
};

// What covers the texels, weighted by clamp(radius * slope + offset, 0, 1). Coverage may exceed 1 where discs that
// differ overlap.
DepthOfFieldCover depth_of_field_cover(ivec2 corner, float extent, vec4 slope, float offset, vec2 shift,
                                       sampler2D layer, sampler2D thickness) {
    DepthOfFieldCover cover = DepthOfFieldCover(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0),
                                                depth_of_field_empty_square());
    ivec2 last = textureSize(layer, 0) - 1;
    int rows = int(extent);
    for (int y = -rows; y <= rows + 1; ++y) {
        int columns = depth_of_field_square_columns(extent, y);
        int row = clamp(corner.y + y, 0, last.y);
        vec2 left = depth_of_field_distances(-columns - 1, y);
        for (int x = -columns; x <= columns + 1; ++x) {
            ivec2 at = ivec2(clamp(corner.x + x, 0, last.x), row);
            vec4 texel = texelFetch(layer, at, 0);
            vec4 thick = texelFetch(thickness, at, 0).r * clamp(texel.a * slope + offset, 0.0, 1.0);
            vec2 here = depth_of_field_distances(x, y);
            vec4 distance = vec4(here.x, left.x, here.y, left.y);
            left = here;
            float circle = max(texel.a, 0.5);
            vec4 disc = depth_of_field_disc(vec4(circle), distance);
            vec4 coverage = thick * disc;
            cover.coverage += coverage;
            cover.radii += coverage * texel.a;
            cover.red += coverage * texel.r;
            cover.green += coverage * texel.g;
            cover.blue += coverage * texel.b;
            if (DEPTH_OF_FIELD_AXIAL == 1) {
                vec4 density = disc * ((1.0 / circle) * (1.0 / circle));
                depth_of_field_add(cover.colours, texel.rgb, thick, density, vec4(circle), shift, distance);
            }
        }
    }
    return cover;
}

vec4 depth_of_field_light_and_coverage(DepthOfFieldCover cover, int i) {
    return vec4(cover.red[i], cover.green[i], cover.blue[i], cover.coverage[i]);
}

// Colour times coverage, coverage of a texel: the near part by one factor, the rest by another.
vec4 depth_of_field_covered(DepthOfFieldCover all, DepthOfFieldCover near, int i, float near_factor, float far_factor) {
    vec4 near_sum = depth_of_field_light_and_coverage(near, i);
    vec4 sum = near_factor * near_sum + far_factor * (depth_of_field_light_and_coverage(all, i) - near_sum);
    if (DEPTH_OF_FIELD_AXIAL == 1) {
        // The silhouette is green's for all channels: a coverage of each would take another image.
        vec3 near_light = depth_of_field_light(near.colours, i), near_weights = depth_of_field_weights(near.colours, i);
        vec3 light = near_factor * near_light + far_factor * (depth_of_field_light(all.colours, i) - near_light);
        vec3 weights = near_factor * near_weights + far_factor * (depth_of_field_weights(all.colours, i) - near_weights);
        sum.rgb = mix(sum.rgb, light / max(weights, 1e-30) * sum.a, greaterThan(weights, vec3(0.0)));
    }
    return sum;
}

// The foreground's discs that cover the texels of a square: colour times coverage, coverage. Outside their silhouette
// too. Where they cover a texel more than once, the nearer ones hide the farther: those of radii above the mean count
// first.
void depth_of_field_gather_foreground(Pixel pixel, DepthOfFieldGatherForegroundParams params, sampler2D layer,
                                      sampler2D thickness, sampler2D reach, out vec4 first, out vec4 second,
                                      out vec4 third, out vec4 fourth) {
    ivec2 corner = 2 * pixel.index;
    float radius = texelFetch(reach, corner / DEPTH_OF_FIELD_TILE, 0).r;
    // Loops without a turn are what skips work here: software rasterisers run both sides of an `if`.
    float extent = radius > 0.0 ? depth_of_field_extent(radius) + params.axial_reach : -1.0;
    DepthOfFieldCover all =
        depth_of_field_cover(corner, extent, vec4(0.0), 1.0, params.axial_shift, layer, thickness);
    // Slopes add up to about 1: nothing is hidden there, and nothing has to be gathered again.
    vec4 excess = clamp(25.0 * (all.coverage - 1.01), 0.0, 1.0);
    bool overlaps = any(greaterThan(excess, vec4(0.0)));
    vec4 per_mean = 2.0 * all.coverage / max(all.radii, 1e-30);
    DepthOfFieldCover near = depth_of_field_cover(corner, overlaps ? extent : -1.0, per_mean, -1.5,
                                                  params.axial_shift, layer, thickness);
    vec4 together = 1.0 / max(all.coverage, 1.0);
    vec4 near_factor = mix(together, 1.0 / max(near.coverage, 1.0), excess);
    vec4 far_factor = mix(
        together, max(1.0 - near.coverage, 0.0) / max(all.coverage - near.coverage, 1e-30), excess);
    first = depth_of_field_covered(all, near, 0, near_factor.x, far_factor.x);
    second = depth_of_field_covered(all, near, 1, near_factor.y, far_factor.y);
    third = depth_of_field_covered(all, near, 2, near_factor.z, far_factor.z);
    fourth = depth_of_field_covered(all, near, 3, near_factor.w, far_factor.w);
}
