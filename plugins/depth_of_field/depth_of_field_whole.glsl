// Levels that compute whole pixels: their colour, or the picture's own bits where they changed nothing.
vec3 depth_of_field_whole(vec3 color, Pixel pixel, DepthOfFieldWholeParams params, sampler2D blurred) {
    vec4 found = texelFetch(blurred, pixel.index, 0);
    return found.a > 0.0 ? found.rgb : color;
}
