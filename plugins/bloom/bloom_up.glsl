#include "bloom_mirrored.glsl"

// A level brought to the next finer one's size by a B-spline of degree 4: weights (1 10 5)/16 towards the side where
// the finer texel lies, on each axis, in two linear samples. Five zeros where the coarser texels' grid would show.
vec3 bloom_smooth(Pixel pixel, vec2 extent, sampler2D wider) {
    vec2 side = vec2(2 * (pixel.index & 1) - 1);
    vec2 nearest = vec2(pixel.index / 2) + 0.5;
    vec2 near = bloom_mirrored(nearest + side / 3.0, extent, wider);
    vec2 far = bloom_mirrored(nearest - side, extent, wider);
    return 0.87890625 * textureLod(wider, near, 0.0).rgb + 0.00390625 * textureLod(wider, far, 0.0).rgb
         + 0.05859375 * (textureLod(wider, vec2(far.x, near.y), 0.0).rgb + textureLod(wider, vec2(near.x, far.y), 0.0).rgb);
}

// The wider blurs brought to this level's size and mixed with its own light. Where the image is large, linear
// interpolation does: it costs a third.
vec4 bloom_up(Pixel pixel, BloomUpParams params, sampler2D own, sampler2D wider) {
    vec3 blurred = BLOOM_UP_IS_SMOOTH == 1
                       ? bloom_smooth(pixel, params.extent, wider)
                       : textureLod(wider, 0.5 * pixel.position / vec2(textureSize(wider, 0)), 0.0).rgb;
    vec3 here = texelFetch(own, pixel.index, 0).rgb;
    return vec4(blurred + params.own_share * (here - blurred), 1.0); // keeps constant light to the last bit
}
