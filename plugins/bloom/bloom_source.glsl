#include <postfx/numeric.glsl>

bool bloom_is_finite(vec3 light) {
    return postfx_is_finite(light.r) && postfx_is_finite(light.g) && postfx_is_finite(light.b);
}

float bloom_brightness(vec3 light) {
    return max(light.r, max(light.g, light.b));
}

// The share of finite light that glows: nothing below 0, and nothing above what is light; in threshold mode what is above the threshold, along a
// parabola that meets 0 and `above` with their slopes.
vec3 bloom_glowing(vec3 light, float knee_start, float knee_end) {
    light = clamp(light, vec3(0.0), vec3(POSTFX_BRIGHTEST));
    if (BLOOM_HAS_THRESHOLD == 0) return light;
    float brightness = bloom_brightness(light);
    if (brightness <= knee_start) return vec3(0.0);
    float above = brightness - 0.5 * (knee_start + knee_end);
    if (brightness < knee_end) {
        float into = brightness - knee_start;
        above = into * into / (2.0 * (knee_end - knee_start));
    }
    return light * (above / brightness);
}
