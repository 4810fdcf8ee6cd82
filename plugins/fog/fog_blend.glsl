// (1 - e^-x) / x for 0 <= x < 1/2, where the difference would lose digits, all of them at 1e-8: eight terms of the
// series leave an error of 1e-8.
float fog_mean_exp_series(float x) {
    return 1.0 - x * (1.0 / 2.0) * (1.0 - x * (1.0 / 3.0) * (1.0 - x * (1.0 / 4.0) * (1.0 - x * (1.0 / 5.0) *
           (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 7.0) * (1.0 - x * (1.0 / 8.0)))))));
}

// Mean of e^-t over t = 0..x, for x >= 0.
float fog_mean_exp(float x) {
    return x < 0.5 ? fog_mean_exp_series(x) : (1.0 - exp(-x)) / x;
}

// Light that comes through fog of that optical thickness (0 or more), and light that the fog adds (Beer, Lambert).
// Without fog the light keeps its bits; behind opaque fog there is none, were it infinite.
vec3 fog_blend(vec3 color, float thickness, vec3 fog_color, float max_opacity) {
    // Whichever of the two is small is computed first, so that both keep their digits. e^-87 is the smallest normal
    // float32; less than that is nothing.
    bool is_thin = thickness < 0.5;
    float faint = thickness < 87.0 ? exp(-thickness) : 0.0;
    float opacity = is_thin ? thickness * fog_mean_exp_series(thickness) : 1.0 - faint;
    float transmittance = is_thin ? 1.0 - opacity : faint;
    opacity = min(opacity, max_opacity);
    transmittance = max(transmittance, 1.0 - max_opacity);
    vec3 seen = transmittance > 0.0 ? color * transmittance : vec3(0.0);
    return thickness > 0.0 ? seen + opacity * fog_color : color;
}
