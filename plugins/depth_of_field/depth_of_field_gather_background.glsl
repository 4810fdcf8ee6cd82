#include "depth_of_field_square.glsl"

// 0 for what is about as far as a surface of a radius, 1 for what is clearly farther.
vec4 depth_of_field_farther(float other, vec4 inverse_radius) {
    return clamp(4.0 * other * inverse_radius - 5.0, 0.0, 1.0);
}

// Light of what lies clearly farther than the texels of a square and is seen past their edge, by the farther discs
// themselves.
DepthOfFieldSquare depth_of_field_past_edge(ivec2 corner, float extent, vec4 inverse_radius, vec2 shift,
                                            sampler2D layer) {
    DepthOfFieldSquare sum = depth_of_field_empty_square();
    ivec2 last = textureSize(layer, 0) - 1;
    int rows = int(extent);
    for (int y = -rows; y <= rows + 1; ++y) {
        int columns = depth_of_field_square_columns(extent, y);
        int row = clamp(corner.y + y, 0, last.y);
        vec2 left = depth_of_field_distances(-columns - 1, y);
        for (int x = -columns; x <= columns + 1; ++x) {
            vec4 texel = texelFetch(layer, ivec2(clamp(corner.x + x, 0, last.x), row), 0);
            vec2 here = depth_of_field_distances(x, y);
            vec4 distance = vec4(here.x, left.x, here.y, left.y);
            left = here;
            float circle = max(texel.a, 0.5);
            vec4 density = depth_of_field_density(vec4(circle), vec4(1.0 / circle), distance);
            vec4 part = depth_of_field_farther(texel.a, inverse_radius);
            depth_of_field_add(sum, texel.rgb, part, density, vec4(circle), shift, distance);
        }
    }
    return sum;
}

// The light of discs that cover the texels of a square of the background.
//
// A neighbour counts where its own disc covers the texel; one further behind can't spread beyond this texel's disc,
// because this surface hides it, and what shows of it there is its own blur. What is in focus or before it never
// counts.
void depth_of_field_gather_background(Pixel pixel, DepthOfFieldGatherBackgroundParams params, sampler2D layer,
                                      sampler2D reach, out vec4 first, out vec4 second, out vec4 third,
                                      out vec4 fourth) {
    ivec2 corner = 2 * pixel.index, last = textureSize(layer, 0) - 1;
    vec4 own;
    for (int i = 0; i < 4; ++i)
        own[i] = texelFetch(layer, min(corner + ivec2(i & 1, i >> 1), last), 0).a;
    vec4 radius = max(own, 0.5), inverse_radius = 1.0 / radius;
    float most = max(max(own.x, own.y), max(own.z, own.w));
    // Loops without a turn are what skips work here: software rasterisers run both sides of an `if`.
    float extent = most > 0.0 ? depth_of_field_extent(most) + params.axial_reach : -1.0;
    DepthOfFieldSquare near = depth_of_field_empty_square(), far = near; // of what is farther only the weights
    int rows = int(extent);
    for (int y = -rows; y <= rows + 1; ++y) {
        int columns = depth_of_field_square_columns(extent, y);
        int row = clamp(corner.y + y, 0, last.y);
        vec2 left = depth_of_field_distances(-columns - 1, y);
        for (int x = -columns; x <= columns + 1; ++x) {
            vec4 texel = texelFetch(layer, ivec2(clamp(corner.x + x, 0, last.x), row), 0);
            vec2 here = depth_of_field_distances(x, y);
            vec4 distance = vec4(here.x, left.x, here.y, left.y);
            left = here;
            float part = texel.a > 0.0 ? 1.0 : 0.0;
            float circle = max(texel.a, 0.5);
            vec4 held = min(vec4(circle), radius);
            vec4 density = depth_of_field_density(held, max(vec4(1.0 / circle), inverse_radius), distance);
            vec4 far_part = part * depth_of_field_farther(circle, inverse_radius);
            depth_of_field_add(near, texel.rgb, part - far_part, density, held, params.axial_shift, distance);
            depth_of_field_add(far, vec3(0.0), far_part, density, held, params.axial_shift, distance);
        }
    }
    // What is not blurred is not asked for.
    vec4 far_weights = max(far.green_weights, max(far.red_weights, far.blue_weights));
    bool any_farther = any(greaterThan(min(own, far_weights), vec4(0.0)));
    float farthest = texelFetch(reach, corner / DEPTH_OF_FIELD_TILE, 0).b;
    float far_extent = any_farther ? depth_of_field_extent(farthest) + params.axial_reach : -1.0;
    DepthOfFieldSquare past =
        depth_of_field_past_edge(corner, far_extent, inverse_radius, params.axial_shift, layer);
    vec4 texels[4];
    for (int i = 0; i < 4; ++i) {
        vec3 hidden = depth_of_field_weights(far, i);
        vec3 light = depth_of_field_light(near, i) + hidden * depth_of_field_mean(past, i);
        texels[i] = vec4(light / max(depth_of_field_weights(near, i) + hidden, 1e-30), 1.0);
    }
    first = texels[0];
    second = texels[1];
    third = texels[2];
    fourth = texels[3];
}
