// The last stage of a picture for display: clamped, sRGB encoded, dithered to 8-bit codes.
#include <postfx/color.glsl>
#include <postfx/noise.glsl>
#include <postfx/numeric.glsl>

// Stream of postfx_pixel_noise() that belongs to this file.
const uint POSTFX_DITHER_STREAM = 0xd17e4u;

// Light that was multiplied by alpha, without it. Where nothing covers the pixel there is nothing to divide by.
vec3 postfx_divided_by_alpha(vec3 color, float alpha) {
    return alpha > 0.0 ? color / alpha : color;
}

// Display-linear light, any value, to codes in 0..1. NaN is black, +infinity white.
vec3 postfx_encode(vec3 color) {
    return postfx_srgb_encode(clamp(postfx_finite_or(color, 1.0), 0.0, 1.0));
}

// Triangular noise of +-1 code before rounding: the mean is kept and the error's variance does not depend on the
// signal (Wannamaker 1992). Only within reach of both ends it would be clipped, which would shift the mean: there the
// noise shrinks to what fits, so that black stays black and white white.
vec3 postfx_encode_dithered(vec3 color, Pixel pixel) {
    vec3 code = postfx_encode(color) * 255.0;
    vec3 noise = postfx_pixel_noise(pixel.index, POSTFX_DITHER_STREAM) +
                 postfx_pixel_noise(pixel.index, POSTFX_DITHER_STREAM + 1u) - 1.0;
    vec3 room = clamp(min(code, 255.0 - code), 0.0, 1.0);
    return (code + noise * room) / 255.0;
}
