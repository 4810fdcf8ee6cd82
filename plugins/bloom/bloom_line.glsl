// Where an image shows what lies `offset` off, if it goes on as its mirror image again and again. Across the line
// nothing is mirrored: the last texel's centre may lie over the border.
vec2 bloom_unfolded(vec2 place, vec2 offset, vec2 extent) {
    vec2 there = place + offset - 2.0 * extent * floor((place + offset) / (2.0 * extent));
    return mix(place, min(there, 2.0 * extent - there), notEqual(offset, vec2(0.0)));
}

// Sum of the texels at both sides. Only at the picture's own size is a texel's mirror image a texel.
vec3 bloom_pair(vec2 place, vec2 offset, vec2 extent, sampler2D wider) {
    vec2 before = bloom_unfolded(place, -offset, extent), after = bloom_unfolded(place, offset, extent);
    if (BLOOM_LINE_IS_COARSE == 0) return texelFetch(wider, ivec2(before), 0).rgb + texelFetch(wider, ivec2(after), 0).rgb;
    vec2 size = vec2(textureSize(wider, 0));
    return textureLod(wider, before / size, 0.0).rgb + textureLod(wider, after / size, 0.0).rgb;
}

// Three or five texels in a line, `step` texels apart, then mixed with this level's own light.
vec4 bloom_line(Pixel pixel, BloomLineParams params, sampler2D own, sampler2D wider) {
    vec3 sum = (1.0 - 2.0 * (params.near + params.far)) * texelFetch(wider, pixel.index, 0).rgb
             + params.near * bloom_pair(pixel.position, params.offset, params.extent, wider);
    if (params.far > 0.0) sum += params.far * bloom_pair(pixel.position, 2.0 * params.offset, params.extent, wider);
    if (params.own_share > 0.0) sum += params.own_share * (texelFetch(own, pixel.index, 0).rgb - sum);
    return vec4(sum, 1.0);
}
