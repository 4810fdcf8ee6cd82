// Guards by bit test: GLSL leaves isnan, min and clamp of NaN, and pow at the edges undefined or unreliable.

bool postfx_is_finite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

// The largest finite value of rgba16f, the format that chains work in: as bright as light gets.
const float POSTFX_BRIGHTEST = 65504.0;

// Light that other pixels may get a share of: NaN as black, and nothing beyond +-POSTFX_BRIGHTEST, infinite or not. So
// one pixel that is not light does not light the picture, and sums stay far from the ends of float32.
float postfx_light(float x) {
    bool is_nan = (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
    return is_nan ? 0.0 : clamp(x, -POSTFX_BRIGHTEST, POSTFX_BRIGHTEST);
}

vec2 postfx_light(vec2 x) {
    return vec2(postfx_light(x.x), postfx_light(x.y));
}

vec3 postfx_light(vec3 x) {
    return vec3(postfx_light(x.xy), postfx_light(x.z));
}

// Is that what the light is already?
bool postfx_is_light(vec3 x) {
    return all(lessThanEqual(floatBitsToUint(x) & 0x7fffffffu, uvec3(floatBitsToUint(POSTFX_BRIGHTEST))));
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
