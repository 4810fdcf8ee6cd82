#include "depth_of_field_disc.glsl"

// Weight of what is in focus where blurred background is filtered together with it: only if there is nothing else. A
// power of two, so that colours survive it.
const float DEPTH_OF_FIELD_IN_FOCUS = 1.0 / 65536.0;

// The background, blurred: colour times weight, weight. That is 1 where it is blurred or seen behind foreground,
// nearly none in focus, 0 where no background is in reach. A neighbour counts where its own disc covers this texel;
// one further behind can't spread beyond this texel's disc, because this surface hides it. What is in focus or before
// it never counts. Hidden texels, behind foreground that may turn transparent, are filled from all that is visible
// nearby.
vec4 depth_of_field_background(Pixel pixel, DepthOfFieldBackgroundParams params, sampler2D layer, sampler2D reach) {
    vec4 own = texelFetch(layer, pixel.index, 0);
    vec2 around = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).rg;
    bool hidden = own.a < 0.0;
    float radius = hidden ? around.r * around.g : own.a;
    vec3 shift = DEPTH_OF_FIELD_AXIAL == 1 && !hidden ? params.axial_shift : vec3(0.0);
    float least = hidden ? radius : 0.0; // every neighbour has this circle, if hidden
    float behind = hidden ? -0.5 : 0.0;  // the class of neighbours that count
    // Loops without a turn are what skips work here: software rasterisers run both sides of an `if`.
    float outer = radius > 0.0 ? radius + 0.5 + (DEPTH_OF_FIELD_AXIAL == 1 ? params.axial_reach : 0.0) : 0.0;
    ivec2 last = textureSize(layer, 0) - 1;
    int rows = int(outer);
    vec3 sum = vec3(0.0), weights = vec3(0.0); // without aberration all weights are the first
    for (int y = depth_of_field_first_row(rows); y <= rows; y += DEPTH_OF_FIELD_ROW_STEP) {
        float row_squared = float(y) * float(y);
        int columns = int(sqrt(outer * outer - row_squared));
        int row = clamp(pixel.index.y + y, 0, last.y);
        for (int x = depth_of_field_first_column(columns, y); x <= columns; x += DEPTH_OF_FIELD_COLUMN_STEP) {
            vec4 texel = texelFetch(layer, ivec2(clamp(pixel.index.x + x, 0, last.x), row), 0);
            float circle = min(max(texel.a, least), radius);
            float squared = float(x) * float(x) + row_squared;
            if (DEPTH_OF_FIELD_AXIAL == 1) {
                vec3 weight = depth_of_field_light_discs(circle, shift, squared);
                weight = texel.a > behind ? weight : vec3(0.0);
                sum += weight * texel.rgb;
                weights += weight;
            } else {
                float weight = texel.a > behind ? depth_of_field_light_discs(circle, vec3(0.0), squared).r : 0.0;
                sum += weight * texel.rgb;
                weights.r += weight;
            }
        }
    }
    if (own.a == 0.0) return DEPTH_OF_FIELD_IN_FOCUS * vec4(own.rgb, 1.0);
    if (DEPTH_OF_FIELD_AXIAL == 0) weights = weights.rrr;
    bool found = min(weights.r, min(weights.g, weights.b)) > 0.0 && radius > 0.0;
    return found ? vec4(sum / weights, 1.0) : vec4(0.0);
}
