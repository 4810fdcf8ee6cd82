// What a sample counts for: NaN as black, and nothing beyond +-65504, the largest half float, so that a pixel that
// is not light does not reach others. By bit test: comparisons with NaN are unreliable.
float chromatic_aberration_light(float x) {
    bool is_nan = (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
    return is_nan ? 0.0 : clamp(x, -65504.0, 65504.0);
}

vec2 chromatic_aberration_light(vec2 x) {
    return vec2(chromatic_aberration_light(x.x), chromatic_aberration_light(x.y));
}

vec3 chromatic_aberration_light(vec3 x) {
    return vec3(chromatic_aberration_light(x.xy), chromatic_aberration_light(x.z));
}
