// Censuses as they are counted: atomics know integers only, so floats are mapped to integers of the same order.
struct PostfxCensusBits {
    uint lowest[3], highest[3];
    uint spoiled; // pixels that are NaN, 0 or more than 0
    uint skies;   // pixels of sky, likewise
};
layout(std430, binding = 1) buffer PostfxCensuses { PostfxCensusBits postfx_censuses[]; };

uint postfx_ordered(float value) {
    uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float postfx_from_ordered(uint ordered) {
    return uintBitsToFloat((ordered & 0x80000000u) != 0u ? ordered & 0x7fffffffu : ~ordered);
}
