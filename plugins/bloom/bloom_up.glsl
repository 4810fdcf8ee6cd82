// The wider levels brought to this level's size and mixed with it. The 3x3 tent of bilinear samples (Jimenez 2014) at
// this level's texel centres, a quarter texel off the wider level's, is 4x4 texels with weights (1 5 7 3)/16.
vec4 bloom_up(Pixel pixel, BloomUpParams params, sampler2D own, sampler2D wider) {
    ivec2 last = textureSize(wider, 0) - 1;
    ivec2 nearest = pixel.index / 2;
    ivec2 side = 2 * (pixel.index & 1) - 1; // towards the second nearest texel
    ivec4 x = clamp(nearest.x + side.x * ivec4(2, 1, 0, -1), 0, last.x);
    ivec4 y = clamp(nearest.y + side.y * ivec4(2, 1, 0, -1), 0, last.y);
    const vec4 weight = vec4(0.0625, 0.3125, 0.4375, 0.1875);
    vec3 blurred = vec3(0.0);
    for (int j = 0; j < 4; ++j) {
        vec3 row = vec3(0.0);
        for (int i = 0; i < 4; ++i) row += weight[i] * texelFetch(wider, ivec2(x[i], y[j]), 0).rgb;
        blurred += weight[j] * row;
    }
    vec3 here = texelFetch(own, pixel.index, 0).rgb;
    return vec4(here + params.wider_share * (blurred - here), 1.0);
}
