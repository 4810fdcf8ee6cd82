// A level to the next coarser one, weights (1 3 4 4 3 1)/16 on each axis: the marginals of the 13-tap kernel of
// Jimenez (SIGGRAPH 2014), as a product, so that the weights are exact at every size. They factor as
// (1+z)^3 (1+z^2): three zeros where aliasing would land on constant light, none left in its centroid.
vec4 bloom_down(Pixel pixel, BloomDownParams params, sampler2D finer) {
    ivec2 last = textureSize(finer, 0) - 1;
    const float weight[6] = float[6](0.0625, 0.1875, 0.25, 0.25, 0.1875, 0.0625);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 6; ++j) {
        int y = clamp(2 * pixel.index.y + j - 2, 0, last.y);
        vec3 row = vec3(0.0);
        for (int i = 0; i < 6; ++i) {
            int x = clamp(2 * pixel.index.x + i - 2, 0, last.x);
            row += weight[i] * texelFetch(finer, ivec2(x, y), 0).rgb;
        }
        sum += weight[j] * row;
    }
    return vec4(sum, 1.0);
}
