#include "depth_of_field_circle.glsl"
#include "depth_of_field_light.glsl"

// This pixel's own circle decides how much of it is sharp; blurred foreground lies over everything. Where foreground
// thins out inside its own silhouette, the background found nearby shows.
vec3 depth_of_field(vec3 color, Pixel pixel, DepthOfFieldParams params, sampler2D depth, sampler2D background,
                    sampler2D foreground, sampler2D reach) {
    float circle = depth_of_field_circle(texelFetch(depth, pixel.index, 0).r, params.lens);
    if (DEPTH_OF_FIELD_VIEW == 1) return vec3(max(-circle, 0.0), 0.0, max(circle, 0.0));
    float share = clamp((abs(circle) - params.sharp_diameter) * params.softening, 0.0, 1.0);
    float far_share = circle > 0.0 ? share : 0.0;
    float near_share = circle > 0.0 ? 0.0 : share;
    ivec2 texel = pixel.index / params.block;
    bool covered = texelFetch(reach, texel / DEPTH_OF_FIELD_TILE, 0).r > 0.0;
    if (share == 0.0 && !covered) return color;

    vec2 place = pixel.position / float(params.block) - 0.5;
    ivec2 corner = ivec2(floor(place));
    vec2 fraction = place - vec2(corner);
    ivec2 last = textureSize(background, 0) - 1;
    vec4 behind = vec4(0.0), before = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        vec2 part = mix(1.0 - fraction, fraction, vec2(offset));
        ivec2 at = clamp(corner + offset, ivec2(0), last);
        if (covered) before += part.x * part.y * texelFetch(foreground, at, 0);
        if (share > 0.0) {
            vec4 found = texelFetch(background, at, 0);
            // A blurred pixel takes nothing from texels in focus; a near one may: they lie behind it.
            if (found.a > 0.0 || (far_share == 0.0 && found.a == 0.0)) {
                behind += part.x * part.y * vec4(found.rgb, 1.0);
            }
        }
    }
    if (share == 0.0 && before.a == 0.0) return color;
    vec3 sharp = depth_of_field_light(color);
    vec3 blurred = sharp;
    if (before.a > 0.0) blurred = before.rgb / before.a; // deep inside a foreground: nothing behind it is known
    if (behind.a > 0.0) blurred = behind.rgb / behind.a;
    float uncovered = max(near_share - before.a, 0.0);
    float rest = 1.0 - max(near_share, before.a);
    return before.rgb + uncovered * blurred + rest * mix(sharp, blurred, far_share);
}
