#include <postfx/numeric.glsl>

// The glow at a pixel, of which each texel stands for BLOOM_BLOCK x BLOOM_BLOCK pixels.
vec3 bloom_glow(Pixel pixel, vec2 uv_per_pixel, sampler2D glow) {
    if (BLOOM_BLOCK == 1) return texelFetch(glow, pixel.index, 0).rgb;
    return textureLod(glow, pixel.position * uv_per_pixel, 0.0).rgb;
}

// What is added may not lift a half float over its largest value.
vec3 bloom_added(vec3 color, vec3 glow) {
    return color + min(glow, max(vec3(0.0), POSTFX_BRIGHTEST - color));
}
