// Distance in texture coordinates, so that on a wide picture the darkening is an ellipse.
vec3 vignette_classic(vec3 color, Pixel pixel, VignetteClassicParams params) {
    float shape = 1.0 - pow(1.2 * length(pixel.uv - 0.5), 3.0);
    return color * ((1.0 - params.strength) + params.strength * shape);
}
