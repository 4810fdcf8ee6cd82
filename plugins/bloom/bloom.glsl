// The half-resolution glow, bilinear (weights 9 3 3 1 over 16 at any size), and the picture it joins.
vec3 bloom(vec3 color, Pixel pixel, BloomParams params, sampler2D glow) {
    ivec2 nearest = pixel.index / 2;
    ivec2 second = clamp(nearest + 2 * (pixel.index & 1) - 1, ivec2(0), textureSize(glow, 0) - 1);
    vec3 scattered = 0.5625 * texelFetch(glow, nearest, 0).rgb
                   + 0.1875 * texelFetch(glow, ivec2(second.x, nearest.y), 0).rgb
                   + 0.1875 * texelFetch(glow, ivec2(nearest.x, second.y), 0).rgb
                   + 0.0625 * texelFetch(glow, second, 0).rgb;
    vec3 room = max(vec3(0.0), params.ceiling - color);
    return params.kept * color + min(params.gain * scattered, room);
}
