// A texel of what was gathered in squares of 2x2.
vec4 depth_of_field_gathered(ivec2 index, sampler2D first, sampler2D second, sampler2D third, sampler2D fourth) {
    ivec2 at = index / 2;
    vec4 here = (index.x & 1) == 0 ? texelFetch(first, at, 0) : texelFetch(second, at, 0);
    vec4 next_row = (index.x & 1) == 0 ? texelFetch(third, at, 0) : texelFetch(fourth, at, 0);
    return (index.y & 1) == 0 ? here : next_row;
}
