// What lies outside an image is its mirror image: no light is lost at the border, and none is made.

// Texels up to a size away from an axis of `size` texels; of tinier axes the texel that is there.
ivec4 bloom_mirrored(ivec4 index, int size) {
    index = max(index, ~index); // ~i is -1 - i
    return clamp(min(index, 2 * size - 1 - index), 0, size - 1);
}

// The same for a place in texels, to be filtered linearly: texture coordinates. The border lies at `extent`, which
// may be within the last texel.
vec2 bloom_mirrored(vec2 place, vec2 extent, sampler2D light) {
    return (extent - abs(extent - abs(place))) / vec2(textureSize(light, 0));
}
