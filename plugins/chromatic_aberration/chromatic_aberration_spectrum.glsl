#include <postfx/numeric.glsl>

// Weights of sample `i` of `taps` on the way from green's wavelength to one end of the spectrum: for the channel of
// that end, whose kernel rises linearly from green's wavelength to its own, and for green, whose kernel falls (half
// of it lies on either side). The image between samples is taken as linear and the kernels are integrated over it
// exactly: whatever the number of samples, the weights of a channel sum to 1 and its mean displacement is right.
// Green's wavelength itself is not displaced; its sample is the pixel, and its weight is what the others leave.
vec2 chromatic_aberration_weights(int i, int taps) {
    float width = 1.0 / float(taps);
    float along = float(i) * width;
    return i < taps ? vec2(2.0 * width * along, width * (1.0 - along))
                    : vec2(width - width * width / 3.0, width * width / 6.0);
}

// The pixel with what both ends of the spectrum change. Sums are of differences from the pixel, so that a constant
// stays as it is to the last bit. red: changes of (red, green), blue: of (blue, green). The middle of a bright pixel
// may be brighter than its mean, and weights are rounded: the sum is held to light again.
vec3 chromatic_aberration_sum(vec3 light, vec2 red, vec2 blue) {
    return postfx_light(light + vec3(red.x, red.y + blue.y, blue.x));
}
