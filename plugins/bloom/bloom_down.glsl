#include "bloom_mirrored.glsl"

// A level to the next coarser one, weights (1 3 4 4 3 1)/16 on each axis: the marginals of the 13-tap kernel of
// Jimenez (SIGGRAPH 2014), as a product, so that the weights are exact at every size. They factor as
// (1+z)^3 (1+z^2): three zeros where aliasing would land on constant light, none left in its centroid. Three linear
// samples per axis, at fractions that the 8 bits of a GPU's filter hold exactly.
vec4 bloom_down(Pixel pixel, BloomDownParams params, sampler2D finer) {
    vec2 first = bloom_mirrored(2.0 * pixel.position - 1.75, params.extent, finer);
    vec2 middle = bloom_mirrored(2.0 * pixel.position, params.extent, finer);
    vec2 last = bloom_mirrored(2.0 * pixel.position + 1.75, params.extent, finer);
    vec3 corners = textureLod(finer, first, 0.0).rgb + textureLod(finer, vec2(last.x, first.y), 0.0).rgb
                 + textureLod(finer, vec2(first.x, last.y), 0.0).rgb + textureLod(finer, last, 0.0).rgb;
    vec3 sides = textureLod(finer, vec2(middle.x, first.y), 0.0).rgb + textureLod(finer, vec2(first.x, middle.y), 0.0).rgb
               + textureLod(finer, vec2(last.x, middle.y), 0.0).rgb + textureLod(finer, vec2(middle.x, last.y), 0.0).rgb;
    vec3 center = textureLod(finer, middle, 0.0).rgb;
    return vec4(0.0625 * corners + 0.125 * sides + 0.25 * center, 1.0);
}
