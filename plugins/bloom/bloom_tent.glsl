// A level brought to the next finer one's size by a 3x3 tent of linear interpolations (Jimenez, SIGGRAPH 2014). Texel
// centres of the finer level lie a quarter texel off the wider level's, so that is 4x4 texels, weights (1 5 7 3)/16.
vec3 bloom_tent(ivec2 index, sampler2D wider) {
    ivec2 last = textureSize(wider, 0) - 1;
    ivec2 nearest = index / 2;
    ivec2 side = 2 * (index & 1) - 1; // towards the second nearest texel
    ivec4 x = clamp(nearest.x + side.x * ivec4(2, 1, 0, -1), 0, last.x);
    ivec4 y = clamp(nearest.y + side.y * ivec4(2, 1, 0, -1), 0, last.y);
    const vec4 weight = vec4(0.0625, 0.3125, 0.4375, 0.1875);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 4; ++j) {
        vec3 row = vec3(0.0);
        for (int i = 0; i < 4; ++i) row += weight[i] * texelFetch(wider, ivec2(x[i], y[j]), 0).rgb;
        sum += weight[j] * row;
    }
    return sum;
}
