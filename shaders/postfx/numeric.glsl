// Guards by bit test: GLSL leaves isnan, min and clamp of NaN, and pow at the edges undefined or unreliable.

bool postfx_is_finite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

// NaN to 0, infinities to +-limit; finite values are returned as they are.
float postfx_finite_or(float x, float limit) {
    if (postfx_is_finite(x)) return x;
    bool is_nan = (floatBitsToUint(x) & 0x007fffffu) != 0u;
    return is_nan ? 0.0 : ((floatBitsToUint(x) & 0x80000000u) != 0u ? -limit : limit);
}

vec3 postfx_finite_or(vec3 x, float limit) {
    return vec3(postfx_finite_or(x.r, limit), postfx_finite_or(x.g, limit), postfx_finite_or(x.b, limit));
}
