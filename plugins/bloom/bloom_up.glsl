#include "bloom_bilinear.glsl"
#include "bloom_tent.glsl"

// The wider levels brought to this level's size and mixed with it. The tent makes the blur round; at half resolution,
// where it would cost most, it adds least.
vec4 bloom_up(Pixel pixel, BloomUpParams params, sampler2D own, sampler2D wider) {
    vec3 blurred = BLOOM_UP_IS_TENT == 1 ? bloom_tent(pixel.index, wider) : bloom_bilinear(pixel.index, wider);
    vec3 here = texelFetch(own, pixel.index, 0).rgb;
    return vec4(here + params.wider_share * (blurred - here), 1.0);
}
