// Joins the parts of a lattice: a texel saw only every second or fourth neighbour, those beside it the others. A tent
// two texels wide gives each part the same weight, whichever the lattice, so that every disc becomes even.
//
// Blurred background (weight 1) takes only such, all else stays.
void depth_of_field_fill(Pixel pixel, DepthOfFieldFillParams params, sampler2D background, sampler2D foreground,
                         out vec4 filled_background, out vec4 filled_foreground) {
    ivec2 last = pixel.size - 1;
    vec4 own = texelFetch(background, pixel.index, 0);
    vec4 behind = 0.25 * own;
    vec4 before = 0.25 * texelFetch(foreground, pixel.index, 0);
    for (int i = 0; i < 8; ++i) { // beside, above, at the corners
        ivec2 offset = i < 2 ? ivec2(1, 0) : i < 4 ? ivec2(0, 1) : i < 6 ? ivec2(1, 1) : ivec2(1, -1);
        ivec2 at = clamp(pixel.index + offset * (1 - 2 * (i & 1)), ivec2(0), last);
        float part = i < 4 ? 0.125 : 0.0625;
        vec4 texel = texelFetch(background, at, 0);
        behind += (texel.a == 1.0 ? part : 0.0) * texel;
        before += part * texelFetch(foreground, at, 0);
    }
    filled_background = own.a == 1.0 ? behind / behind.a : own;
    filled_foreground = before;
}
