#include "depth_of_field_disc.glsl"
#include "depth_of_field_sum.glsl"

// Weight of what is in focus where blurred background is filtered together with it: only if there is nothing else. A
// power of two, so that colours survive it.
const float DEPTH_OF_FIELD_IN_FOCUS = 1.0 / 65536.0;

// Large discs have texels enough for a thinner lattice.
int depth_of_field_background_lattice(float radius) {
    if (radius < DEPTH_OF_FIELD_THIN_FROM) return 1;
    return radius < DEPTH_OF_FIELD_THINNEST_FROM ? 2 : 4;
}

// 0 for what is about as far as a surface of that radius, 1 for what is clearly farther.
float depth_of_field_farther(float other, float inverse_radius) {
    return clamp(4.0 * other * inverse_radius - 5.0, 0.0, 1.0);
}

// Light of what lies clearly farther than this texel and is seen past its edge, by the farther discs themselves.
DepthOfFieldSum depth_of_field_past_edge(ivec2 index, float outer, float inverse_radius, vec3 shift, sampler2D layer) {
    DepthOfFieldSum sum = DepthOfFieldSum(vec3(0.0), vec3(0.0));
    ivec2 last = textureSize(layer, 0) - 1;
    int lattice = depth_of_field_background_lattice(outer - 0.5);
    int rows = int(outer);
    for (int y = depth_of_field_first_row(lattice, rows); y <= rows; y += depth_of_field_row_step(lattice)) {
        float row_squared = float(y) * float(y);
        int columns = int(sqrt(max(outer * outer - row_squared, 0.0)));
        int row = clamp(index.y + y, 0, last.y);
        int column_step = depth_of_field_column_step(lattice);
        for (int x = depth_of_field_first_column(lattice, columns, y); x <= columns; x += column_step) {
            vec4 texel = texelFetch(layer, ivec2(clamp(index.x + x, 0, last.x), row), 0);
            float part = depth_of_field_farther(texel.a, inverse_radius);
            depth_of_field_add(sum, texel.rgb, part, texel.a, shift, float(x) * float(x) + row_squared);
        }
    }
    return sum;
}

// What a hole shows behind which no background is in reach: the farthest foreground, that of the smallest circles.
vec4 depth_of_field_farthest(ivec2 index, int rows, sampler2D before, sampler2D thickness) {
    vec4 sum = vec4(0.0);
    ivec2 last = textureSize(before, 0) - 1;
    int lattice = depth_of_field_background_lattice(float(rows));
    for (int y = depth_of_field_first_row(lattice, rows); y <= rows; y += depth_of_field_row_step(lattice)) {
        int columns = int(sqrt(float(rows * rows - y * y)));
        int row = clamp(index.y + y, 0, last.y);
        int column_step = depth_of_field_column_step(lattice);
        for (int x = depth_of_field_first_column(lattice, columns, y); x <= columns; x += column_step) {
            ivec2 at = ivec2(clamp(index.x + x, 0, last.x), row);
            vec4 texel = texelFetch(before, at, 0);
            float weight = 1.0 / max(texel.a, 0.5);
            weight *= weight;
            weight *= weight;
            weight *= weight;
            sum += texelFetch(thickness, at, 0).r > 0.0 ? weight * vec4(texel.rgb, 1.0) : vec4(0.0);
        }
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, float(lattice)) : vec4(0.0);
}

// The background, blurred: colour times weight, weight. That is 1 where it is blurred or seen behind foreground,
// nearly none in focus, 0 where nothing is in reach. A neighbour counts where its own disc covers this texel; one
// further behind can't spread beyond this texel's disc, because this surface hides it, and what shows of it there is
// its own blur. What is in focus or before it never counts. Hidden texels, behind foreground that may turn
// transparent, are filled from all that is visible nearby.
vec4 depth_of_field_background(Pixel pixel, DepthOfFieldBackgroundParams params, sampler2D layer, sampler2D before,
                               sampler2D thickness, sampler2D covered, sampler2D reach) {
    vec4 own = texelFetch(layer, pixel.index, 0);
    vec3 around = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).rgb;
    bool hidden = own.a < 0.0;
    float radius = hidden ? around.r * around.g : own.a;
    vec3 shift = DEPTH_OF_FIELD_AXIAL == 1 && !hidden ? params.axial_shift : vec3(0.0);
    float beyond = 0.5 + (DEPTH_OF_FIELD_AXIAL == 1 ? params.axial_reach : 0.0);
    float least = hidden ? radius : 0.0; // every neighbour has this circle, if hidden
    float behind = hidden ? -0.5 : 0.0;  // the class of neighbours that count
    float inverse_radius = hidden ? 0.0 : 1.0 / max(radius, 0.5);
    // Loops without a turn are what skips work here: software rasterisers run both sides of an `if`.
    float outer = radius > 0.0 ? radius + beyond : 0.0;
    int lattice = depth_of_field_background_lattice(radius);
    ivec2 last = textureSize(layer, 0) - 1;
    int rows = int(outer);
    DepthOfFieldSum sum = DepthOfFieldSum(vec3(0.0), vec3(0.0)), farther = sum;
    for (int y = depth_of_field_first_row(lattice, rows); y <= rows; y += depth_of_field_row_step(lattice)) {
        float row_squared = float(y) * float(y);
        int columns = int(sqrt(outer * outer - row_squared));
        int row = clamp(pixel.index.y + y, 0, last.y);
        int column_step = depth_of_field_column_step(lattice);
        for (int x = depth_of_field_first_column(lattice, columns, y); x <= columns; x += column_step) {
            vec4 texel = texelFetch(layer, ivec2(clamp(pixel.index.x + x, 0, last.x), row), 0);
            float circle = min(max(texel.a, least), radius);
            float squared = float(x) * float(x) + row_squared;
            float part = texel.a > behind ? 1.0 : 0.0;
            float far_part = part * depth_of_field_farther(texel.a, inverse_radius);
            depth_of_field_add(sum, texel.rgb, part - far_part, circle, shift, squared);
            depth_of_field_add(farther, texel.rgb, far_part, circle, shift, squared);
        }
    }
    vec3 far_weights = depth_of_field_weights(farther);
    float far_outer = max(far_weights.r, max(far_weights.g, far_weights.b)) > 0.0 ? around.b + beyond : -1.0;
    DepthOfFieldSum past = depth_of_field_past_edge(pixel.index, far_outer, inverse_radius, shift, layer);
    vec3 light = sum.light + far_weights * depth_of_field_mean(past);
    vec3 weights = depth_of_field_weights(sum) + far_weights;
    if (own.a == 0.0) return DEPTH_OF_FIELD_IN_FOCUS * vec4(own.rgb, 1.0);
    if (radius > 0.0 && min(weights.r, min(weights.g, weights.b)) > 0.0) return vec4(light / weights, float(lattice));
    bool open = hidden && texelFetch(covered, pixel.index, 0).a < 0.98;
    return depth_of_field_farthest(pixel.index, open ? int(around.r) : -1, before, thickness);
}
