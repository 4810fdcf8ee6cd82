#include "rim_light_surface.glsl"

// Reflectance of a dielectric for light of all polarisations, index > 1 (Fresnel; this form: Cook and Torrance 1982).
float rim_light_fresnel(float cosine, float index) {
    float g = sqrt(index * index - 1.0 + cosine * cosine);
    float parallel_over_crossed = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    float crossed = (g - cosine) / (g + cosine);
    return 0.5 * crossed * crossed * (1.0 + parallel_over_crossed * parallel_over_crossed);
}

// Share of the light by the angle between normal and eye. Both faces of a surface are alike, whichever way its normal
// points: the cosine's sign is dropped. The ramp needs no division, so no width makes 0/0.
vec3 rim_light(vec3 color, Pixel pixel, RimLightParams params, sampler2D normal) {
    vec3 n = rim_light_surface(pixel, normal), to_eye = rim_light_to_eye(pixel);
    float squared = dot(n, n);
    float cosine = min(abs(dot(n, to_eye)) * inversesqrt(squared * dot(to_eye, to_eye)), 1.0);
    float share;
    if (RIM_LIGHT_PROFILE == 0) {
        share = 1.0 - cosine * params.slope;
    } else {
        share = rim_light_fresnel(cosine, params.refractive_index);
    }
    return rim_light_add(color, squared > 0.0 ? share : 0.0, params.light);
}
