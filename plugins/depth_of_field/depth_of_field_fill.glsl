// The texels around one, in turns of opposite ones: beside, above, at the corners.
ivec2 depth_of_field_beside(int i) {
    ivec2 offset = i < 2 ? ivec2(1, 0) : i < 4 ? ivec2(0, 1) : i < 6 ? ivec2(1, 1) : ivec2(1, -1);
    return offset * (1 - 2 * (i & 1));
}

// Joins the parts of a lattice: a texel saw only every second or fourth neighbour, those beside it the others. Every
// second: the four beside it saw what it did not, and together get the same weight as it. Every fourth: a tent two
// texels wide gives each part the same weight. So every disc becomes even.
//
// Of the background, alpha is the lattice that a blurred texel was gathered from, and becomes 1; such texels take
// only such, all else stays.
void depth_of_field_fill(Pixel pixel, DepthOfFieldFillParams params, sampler2D background, sampler2D foreground,
                         sampler2D reach, out vec4 filled_background, out vec4 filled_foreground) {
    ivec2 last = textureSize(background, 0) - 1;
    vec4 own = texelFetch(background, pixel.index, 0), near = texelFetch(foreground, pixel.index, 0);
    bool covered = texelFetch(reach, pixel.index / DEPTH_OF_FIELD_TILE, 0).r > 0.0;
    // Loops without a turn are what skips work here. Of the eight texels around, those beside come first.
    int behind_count = own.a == 2.0 ? 4 : own.a == 4.0 ? 8 : 0;
    int near_lattice = covered ? DEPTH_OF_FIELD_FOREGROUND_LATTICE : 1;
    int before_count = near_lattice == 2 ? 4 : near_lattice == 4 ? 8 : 0;
    vec4 behind = (behind_count == 4 ? 0.5 : 0.25) * vec4(own.rgb, 1.0);
    vec4 before = (before_count == 4 ? 0.5 : 0.25) * near;
    for (int i = 0; i < behind_count; ++i) {
        vec4 texel = texelFetch(background, clamp(pixel.index + depth_of_field_beside(i), ivec2(0), last), 0);
        behind += texel.a >= 1.0 ? (i < 4 ? 0.125 : 0.0625) * vec4(texel.rgb, 1.0) : vec4(0.0);
    }
    for (int i = 0; i < before_count; ++i) {
        vec4 texel = texelFetch(foreground, clamp(pixel.index + depth_of_field_beside(i), ivec2(0), last), 0);
        before += (i < 4 ? 0.125 : 0.0625) * texel;
    }
    filled_background = behind_count > 0 ? vec4(behind.rgb / behind.a, 1.0) : vec4(own.rgb, min(own.a, 1.0));
    filled_foreground = before_count > 0 ? before : near;
}
