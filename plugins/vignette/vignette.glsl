// Twice the pixel's offset from the picture's centre, in pixels: an integer, so that mirrored pixels have mirrored
// offsets to the last bit and the centre is exactly 0.
vec2 vignette_offset(Pixel pixel) {
    return vec2(2 * pixel.index + 1 - pixel.size);
}

// cos^4 of the angle between the pixel's ray and the optical axis. With t = tan(angle) it is 1 / (1 + t^2)^2, without
// any trigonometry.
float vignette_natural(Pixel pixel, VignetteParams params) {
    vec2 from_axis = vignette_offset(pixel) - u_frame.principal_point * u_frame.size;
    vec2 slope = from_axis * params.scale;
    float cos_squared = 1.0 / (1.0 + dot(slope, slope));
    return cos_squared * cos_squared;
}

// 1 inside the radius, 0 from radius + softness on, a cubic between.
float vignette_artistic(Pixel pixel, VignetteParams params) {
    float distance_from_edge = length(vignette_offset(pixel) * params.scale) - params.radius;
    float x = clamp(distance_from_edge / params.softness, 0.0, 1.0);
    return 1.0 - x * x * (3.0 - 2.0 * x);
}

vec3 vignette(vec3 color, Pixel pixel, VignetteParams params) {
    float shape = VIGNETTE_MODEL == 0 ? vignette_natural(pixel, params) : vignette_artistic(pixel, params);
    // In this form the gain is exactly 1 where shape is 1, and exactly shape where strength is 1.
    float gain = (1.0 - params.strength) + params.strength * shape;
    // cos^4 is never 0. Where no light arrives the picture is black whatever the scene holds: 0 * infinity would be
    // NaN.
    return VIGNETTE_MODEL == 0 || gain > 0.0 ? color * gain : vec3(0.0);
}
