// Optical thickness that counts as opaque. e^-87 is the smallest normal float32; beyond, light is gone.
const float FOG_OPAQUE = 87.0;

// Mean of e^-t over t = 0..x, for x >= 0: (1 - e^-x) / x, and 1 at 0. Below 1/2 the difference would lose digits (all of
// them near 1e-8); there eight terms of the series leave 1e-8.
float fog_mean_exp(float x) {
    if (x >= 0.5) return (1.0 - exp(-x)) / x;
    return 1.0 - x * (1.0 / 2.0) * (1.0 - x * (1.0 / 3.0) * (1.0 - x * (1.0 / 4.0) * (1.0 - x * (1.0 / 5.0) *
           (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 7.0) * (1.0 - x * (1.0 / 8.0)))))));
}

// Light that comes through fog of that optical thickness (0 or more), and light that the fog adds (Beer, Lambert).
// Without fog the light keeps its bits; behind opaque fog there is none, were it infinite.
vec3 fog_blend(vec3 color, float thickness, vec3 fog_color, float max_opacity) {
    if (thickness <= 0.0) return color;
    // Whichever of the two is small is computed first, so that both keep their digits.
    float opacity = thickness * fog_mean_exp(thickness);
    float transmittance = 1.0 - opacity;
    if (thickness >= 0.5) {
        transmittance = thickness < FOG_OPAQUE ? exp(-thickness) : 0.0;
        opacity = 1.0 - transmittance;
    }
    if (opacity > max_opacity) {
        opacity = max_opacity;
        transmittance = 1.0 - max_opacity;
    }
    vec3 seen = transmittance > 0.0 ? color * transmittance : vec3(0.0);
    return seen + opacity * fog_color;
}
