#include <postfx/census.glsl>
#include <postfx/census_bits.glsl>
#include <postfx/depth.glsl>

// What a decision does: one thread asks the effect's function, all write which passes are drawn from now on.
layout(local_size_x = 32) in;

layout(std430, binding = 2) buffer PostfxDecisions {
    uint live; // a bit for each decision that is for its effect
    uint unused;
    vec2 compared[]; // what each was made by
} postfx_decisions;

// A pass that is drawn if any of its terms holds.
struct PostfxConditional {
    uvec4 command; // of a draw or dispatch
    uint first_term, term_count;
    uint unused[2];
};
layout(std430, binding = 3) readonly buffer PostfxConditionals { PostfxConditional postfx_conditionals[]; };
layout(std430, binding = 4) readonly buffer PostfxTerms { uvec2 postfx_terms[]; }; // live, dead
layout(std430, binding = 5) writeonly buffer PostfxCommands { uvec4 postfx_commands[]; };

shared uint postfx_live;

Census postfx_census(uint slot) {
    PostfxCensusBits bits = postfx_censuses[slot];
    Census census;
    for (int i = 0; i < 3; ++i) {
        census.lowest[i] = postfx_from_ordered(bits.lowest[i]);
        census.highest[i] = postfx_from_ordered(bits.highest[i]);
    }
    if (bits.spoiled != 0u) census.lowest = census.highest = vec3(uintBitsToFloat(0x7fc00000u));
    return census;
}

DepthCensus postfx_depth_census(uint slot) {
    PostfxCensusBits bits = postfx_censuses[slot];
    DepthCensus census;
    census.has_surface = bits.lowest[0] <= bits.highest[0];
    census.has_sky = bits.skies != 0u;
    float a = postfx_view_z(postfx_from_ordered(bits.lowest[0])), b = postfx_view_z(postfx_from_ordered(bits.highest[0]));
    census.nearest = census.has_surface ? min(a, b) : uintBitsToFloat(0x7f800000u);
    census.farthest = census.has_surface ? max(a, b) : 0.0;
    if (bits.spoiled != 0u) census.nearest = census.farthest = uintBitsToFloat(0x7fc00000u);
    return census;
}

// The first thread brings what the effect compared.
void postfx_decide(uint decision, vec2 compared) {
    if (gl_LocalInvocationIndex == 0u) {
        postfx_decisions.compared[decision] = compared;
        bool skipped = compared.x <= compared.y; // false for NaN: then it runs
        postfx_live = postfx_decisions.live | (skipped ? 0u : 1u << decision);
        postfx_decisions.live = postfx_live;
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < uint(postfx_conditionals.length()); i += gl_WorkGroupSize.x) {
        PostfxConditional conditional = postfx_conditionals[i];
        bool drawn = false;
        for (uint term = 0u; term < conditional.term_count; ++term) {
            uvec2 bits = postfx_terms[conditional.first_term + term];
            drawn = drawn || ((postfx_live & bits.x) == bits.x && (postfx_live & bits.y) == 0u);
        }
        postfx_commands[i] = drawn ? conditional.command : uvec4(0u);
    }
}
