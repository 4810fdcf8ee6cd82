// The hash of a thousand shaders. A float's step in the sine's argument is a third of the range after it is
// multiplied, so the numbers depend on the driver, and with growing time neighbours become equal.
vec3 grain_sine(vec3 color, Pixel pixel, float amount) {
    float number = fract(sin(dot(pixel.uv + u_frame.time, vec2(12.9898, 78.233))) * 43758.5453);
    return color + amount * 1.7320508 * (number - 0.5); // deviation amount / 2, the other levels' in mid-tones
}
