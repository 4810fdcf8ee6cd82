#include "depth_of_field_disc.glsl"

// The foreground's discs that cover this texel: colour times coverage, coverage. Outside its silhouette too.
vec4 depth_of_field_foreground(Pixel pixel, DepthOfFieldForegroundParams params, sampler2D layer, sampler2D shape,
                               sampler2D reach) {
    float radius = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).r;
    if (radius == 0.0) return vec4(0.0);
    ivec2 last = textureSize(shape, 0) - 1;
    float outer = radius + 0.5;
    int rows = int(outer);
    vec4 sum = vec4(0.0);
    for (int y = -rows; y <= rows; ++y) {
        int columns = int(sqrt(outer * outer - float(y * y)));
        for (int x = -columns; x <= columns; ++x) {
            ivec2 at = clamp(pixel.index + ivec2(x, y), ivec2(0), last);
            vec2 disc = texelFetch(shape, at, 0).rg;
            if (disc.g > 0.0) {
                float weight = disc.g * depth_of_field_disc(disc.r, sqrt(float(x * x + y * y)));
                sum += weight * vec4(texelFetch(layer, at, 0).rgb, 1.0);
            }
        }
    }
    return sum / max(1.0, sum.a); // discs on a grid may overlap by some per cent
}
