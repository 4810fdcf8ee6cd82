#include <postfx/census_count.glsl>

void main() {
    ivec2 size = textureSize(u_image, 0), at = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * POSTFX_ROWS);
    if (at.x >= size.x) return;
    vec3 lowest = vec3(uintBitsToFloat(0x7f800000u)), highest = -lowest;
    bool spoiled = false;
    for (int last = min(at.y + POSTFX_ROWS, size.y); at.y < last; ++at.y) {
        vec3 color = texelFetch(u_image, at, 0).rgb;
        lowest = min(lowest, color);
        highest = max(highest, color);
        spoiled = spoiled || any(postfx_is_nan(color));
    }
    for (int channel = 0; channel < 3; ++channel)
        postfx_tell(channel, lowest[channel], highest[channel]);
    if (spoiled) postfx_censuses[u_slot].spoiled = 1u;
}
