#include <postfx/census_count.glsl>

void main() {
    ivec2 size = textureSize(u_image, 0), at = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * POSTFX_ROWS);
    if (at.x >= size.x) return;
    float lowest = uintBitsToFloat(0x7f800000u), highest = -lowest;
    bool spoiled = false, sky = false;
    for (int last = min(at.y + POSTFX_ROWS, size.y); at.y < last; ++at.y) {
        float depth = texelFetch(u_image, at, 0).r;
        bool is_sky = depth == u_frame.sky_depth;
        lowest = is_sky ? lowest : min(lowest, depth);
        highest = is_sky ? highest : max(highest, depth);
        sky = sky || is_sky;
        spoiled = spoiled || any(postfx_is_nan(vec3(depth)));
    }
    if (lowest <= highest) postfx_tell(0, lowest, highest);
    if (spoiled) postfx_censuses[u_slot].spoiled = 1u;
    if (sky) postfx_censuses[u_slot].skies = 1u;
}
