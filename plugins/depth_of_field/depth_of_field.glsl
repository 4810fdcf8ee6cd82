#include "depth_of_field_circle.glsl"
#include "depth_of_field_share.glsl"
#include <postfx/numeric.glsl>

// A reduced layer at a pixel, interpolated. In blocks of an odd number of pixels one lies on the texel's centre,
// where the sampler's rounding would let neighbours in that must count for nothing: there the four taps are weighted
// here.
vec4 depth_of_field_layer(sampler2D layer, vec2 position, vec2 layer_scale) {
    if (DEPTH_OF_FIELD_BY_HAND == 0) return textureLod(layer, position * layer_scale, 0.0);
    ivec2 last = textureSize(layer, 0) - 1;
    vec2 place = position * layer_scale * vec2(last + 1) - 0.5;
    vec2 nearest = floor(place + 0.5);
    vec2 fraction = place - nearest; // -0.5 to 0.5
    fraction = mix(fraction, vec2(0.0), lessThan(abs(fraction), vec2(1.0 / 512.0)));
    ivec2 own = ivec2(nearest), beside = clamp(own + ivec2(sign(fraction)), ivec2(0), last);
    vec4 row = mix(texelFetch(layer, own, 0), texelFetch(layer, ivec2(beside.x, own.y), 0), abs(fraction.x));
    vec4 other_row = mix(texelFetch(layer, ivec2(own.x, beside.y), 0), texelFetch(layer, beside, 0), abs(fraction.x));
    return mix(row, other_row, abs(fraction.y));
}

// This pixel's own circle decides how much of it is sharp; blurred foreground lies over everything. Where foreground
// thins out inside its own silhouette, the background found nearby shows.
vec3 depth_of_field(vec3 color, Pixel pixel, DepthOfFieldParams params, sampler2D depth, sampler2D background,
                    sampler2D foreground) {
    float circle = depth_of_field_circle(texelFetch(depth, pixel.index, 0).r, params.lens);
    float share = depth_of_field_share(circle);
    float far_share = circle > 0.0 ? share : 0.0;
    float near_share = circle > 0.0 ? 0.0 : share;
    // Both are multiplied by their weight in alpha, so that filtering leaves out what counts for nothing.
    vec4 before = depth_of_field_layer(foreground, pixel.position, params.layer_scale);
    vec4 behind = depth_of_field_layer(background, pixel.position, params.layer_scale);
    if (share == 0.0 && before.a == 0.0) return color;
    vec3 sharp = postfx_light(color);
    vec3 blurred = sharp;
    if (before.a > 0.0) blurred = before.rgb / before.a; // deep inside a foreground: nothing behind it is known
    if (behind.a > 0.0) blurred = behind.rgb / behind.a;
    float uncovered = max(near_share - before.a, 0.0);
    float rest = 1.0 - max(near_share, before.a);
    return before.rgb + uncovered * blurred + rest * mix(sharp, blurred, far_share);
}
