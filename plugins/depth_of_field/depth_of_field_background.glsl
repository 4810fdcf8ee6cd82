#include "depth_of_field_disc.glsl"
#include "depth_of_field_gathered.glsl"

// Weight of what is in focus where blurred background is filtered together with it: only if there is nothing else. A
// power of two, so that colours survive it.
const float DEPTH_OF_FIELD_IN_FOCUS = 1.0 / 65536.0;

// What a hole shows: all that is visible nearby, as a disc of that radius gathers it.
vec4 depth_of_field_hole(ivec2 index, float radius, sampler2D layer) {
    vec4 sum = vec4(0.0);
    ivec2 last = textureSize(layer, 0) - 1;
    float extent = radius > 0.0 ? depth_of_field_extent(radius) : -1.0;
    int rows = int(extent);
    for (int y = -rows; y <= rows; ++y) {
        int columns = depth_of_field_columns(extent, float(y));
        int row = clamp(index.y + y, 0, last.y);
        for (int x = -columns; x <= columns; ++x) {
            vec4 texel = texelFetch(layer, ivec2(clamp(index.x + x, 0, last.x), row), 0);
            float weight = depth_of_field_disc(max(radius, 0.5), length(vec2(x, y)));
            sum += texel.a >= 0.0 ? weight * vec4(texel.rgb, 1.0) : vec4(0.0);
        }
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}

// What a hole shows behind which no background is in reach: the farthest foreground, that of the smallest circles.
vec4 depth_of_field_farthest(ivec2 index, int rows, sampler2D before) {
    vec4 sum = vec4(0.0);
    ivec2 last = textureSize(before, 0) - 1;
    for (int y = -rows; y <= rows; ++y) {
        int columns = int(sqrt(float(rows * rows - y * y)));
        int row = clamp(index.y + y, 0, last.y);
        for (int x = -columns; x <= columns; ++x) {
            vec4 texel = texelFetch(before, ivec2(clamp(index.x + x, 0, last.x), row), 0);
            float weight = 1.0 / max(texel.a, 0.5);
            weight *= weight;
            weight *= weight;
            weight *= weight;
            sum += texel.a > 0.0 ? weight * vec4(texel.rgb, 1.0) : vec4(0.0);
        }
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}

// The background, blurred: colour times weight, weight. That is 1 where it is blurred or seen behind foreground,
// nearly none in focus, 0 where nothing is in reach or nothing would be seen of it. Hidden texels, behind foreground
// that turns transparent, are filled.
vec4 depth_of_field_background(Pixel pixel, DepthOfFieldBackgroundParams params, sampler2D first, sampler2D second,
                               sampler2D third, sampler2D fourth, sampler2D layer, sampler2D before,
                               sampler2D covered, sampler2D reach) {
    vec4 own = texelFetch(layer, pixel.index, 0);
    vec2 around = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).rg;
    // Loops without a turn are what skips work here: software rasterisers run both sides of an `if`.
    bool open = own.a < 0.0 && texelFetch(covered, pixel.index, 0).a < 0.98;
    vec4 hole = depth_of_field_hole(pixel.index, open ? around.r * around.g : 0.0, layer);
    bool empty = open && hole.a == 0.0;
    vec4 farthest = depth_of_field_farthest(pixel.index, empty ? int(around.r) : -1, before);
    if (own.a == 0.0) return DEPTH_OF_FIELD_IN_FOCUS * vec4(own.rgb, 1.0);
    if (own.a > 0.0) return depth_of_field_gathered(pixel.index, first, second, third, fourth);
    return empty ? farthest : hole;
}
