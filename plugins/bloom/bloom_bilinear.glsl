// A level brought to the next finer one's size by linear interpolation: weights 9 3 3 1 over 16 at any size.
vec3 bloom_bilinear(ivec2 index, sampler2D wider) {
    ivec2 nearest = index / 2;
    ivec2 second = clamp(nearest + 2 * (index & 1) - 1, ivec2(0), textureSize(wider, 0) - 1);
    return 0.5625 * texelFetch(wider, nearest, 0).rgb
         + 0.1875 * texelFetch(wider, ivec2(second.x, nearest.y), 0).rgb
         + 0.1875 * texelFetch(wider, ivec2(nearest.x, second.y), 0).rgb
         + 0.0625 * texelFetch(wider, second, 0).rgb;
}
