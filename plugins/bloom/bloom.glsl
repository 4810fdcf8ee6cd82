// The picture's own light and the glow, of which each texel stands for BLOOM_BLOCK x BLOOM_BLOCK pixels. What is
// added may not lift a half float over its largest value; a weighted mean can't.
vec3 bloom(vec3 color, Pixel pixel, BloomParams params, sampler2D glow) {
    vec3 scattered = BLOOM_BLOCK == 1
                         ? texelFetch(glow, pixel.index, 0).rgb
                         : textureLod(glow, pixel.position * params.uv_per_pixel, 0.0).rgb;
    scattered *= params.gain;
    if (BLOOM_ADDS == 0) return params.kept * color + scattered;
    return color + min(scattered, max(vec3(0.0), 65504.0 - color));
}
