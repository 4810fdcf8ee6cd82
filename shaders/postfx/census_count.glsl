#include <postfx/census_bits.glsl>

// One thread looks at a column of POSTFX_ROWS pixels, neighbours at neighbouring columns.
layout(local_size_x = 64) in;
const int POSTFX_ROWS = 64;

layout(binding = 0) uniform sampler2D u_image;
layout(location = 0) uniform uint u_slot;

// Most threads have nothing to add to what others found; only the others need the atomic.
void postfx_tell(int channel, float lowest, float highest) {
    uint low = postfx_ordered(lowest), high = postfx_ordered(highest);
    if (low < postfx_censuses[u_slot].lowest[channel]) atomicMin(postfx_censuses[u_slot].lowest[channel], low);
    if (high > postfx_censuses[u_slot].highest[channel]) atomicMax(postfx_censuses[u_slot].highest[channel], high);
}

bvec3 postfx_is_nan(vec3 value) {
    return greaterThan(floatBitsToUint(value) & 0x7fffffffu, uvec3(0x7f800000u));
}
