#include "depth_of_field_disc.glsl"

// The background, blurred: colour, and 1 where it is blurred or seen behind foreground, 0 in focus, -1 where no
// background is in reach. A neighbour counts where its own disc covers this texel; one further behind can't spread
// beyond this texel's disc, because this surface hides it. What is in focus or before it never counts.
vec4 depth_of_field_background(Pixel pixel, DepthOfFieldBackgroundParams params, sampler2D layer, sampler2D reach) {
    vec4 own = texelFetch(layer, pixel.index, 0);
    if (own.a == 0.0) return own;
    bool hidden = own.a < 0.0; // behind foreground that may turn transparent: filled from all that is visible nearby
    vec2 around = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).rg;
    if (hidden && around.g == 0.0) return own;
    float radius = hidden ? around.r : own.a;
    ivec2 last = textureSize(layer, 0) - 1;
    float outer = radius + 0.5;
    int rows = int(outer);
    vec4 sum = vec4(0.0);
    for (int y = -rows; y <= rows; ++y) {
        int columns = int(sqrt(outer * outer - float(y * y)));
        for (int x = -columns; x <= columns; ++x) {
            vec4 texel = texelFetch(layer, clamp(pixel.index + ivec2(x, y), ivec2(0), last), 0);
            float away = sqrt(float(x * x + y * y));
            float weight = 0.0;
            if (hidden) {
                if (texel.a >= 0.0) weight = clamp(outer - away, 0.0, 1.0);
            } else if (texel.a > 0.0) {
                weight = depth_of_field_disc(min(texel.a, radius), away);
            }
            sum += weight * vec4(texel.rgb, 1.0);
        }
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0, 0.0, 0.0, -1.0);
}
