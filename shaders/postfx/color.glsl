// Scene-linear and display colour, Rec. 709 primaries.

// Relative luminance of linear Rec. 709 (ITU-R BT.709).
float postfx_luminance(vec3 linear_color) {
    return dot(linear_color, vec3(0.2126, 0.7152, 0.0722));
}

// IEC 61966-2-1 encoding of display-linear light in 0..1.
vec3 postfx_srgb_encode(vec3 linear_color) {
    vec3 low = 12.92 * linear_color;
    vec3 high = 1.055 * pow(max(linear_color, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear_color, vec3(0.0031308)));
}
