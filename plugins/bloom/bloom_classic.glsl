// What this effect started from: 21x21 texels of a Gaussian of 5 texels, `stride` pixels apart. Cut off at two
// standard deviations and not divided by the weights' sum, it loses a tenth of the light; between its texels it sees
// none.
vec4 bloom_classic(Pixel pixel, BloomClassicParams params, sampler2D light) {
    vec3 sum = vec3(0.0);
    for (int y = -10; y <= 10; ++y) {
        for (int x = -10; x <= 10; ++x) {
            ivec2 at = clamp(pixel.index + params.stride * ivec2(x, y), ivec2(0), pixel.size - 1);
            float weight = exp(float(x * x + y * y) / -50.0) / (50.0 * 3.14159265);
            sum += weight * texelFetch(light, at, 0).rgb;
        }
    }
    return vec4(sum, 1.0);
}
