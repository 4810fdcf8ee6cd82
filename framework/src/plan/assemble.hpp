// Shader text from the functions that effects wrote. Generated around them: constants, parameter structs,
// samplers, main(). Nothing of the author's text is changed but #include lines.
#pragma once

#include <plan/frame_block.hpp>
#include <plan/record.hpp>

#include <postfx/plan.hpp>

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

/// A member of a stage's parameter struct.
struct BlockMember {
    std::string name;
    std::string type; ///< "float", "int", "bool", "vec2", "vec3", "vec4", "ivec2" ...
    std::array<double, 4> value{};
    int components = 1;
    bool operator==(const BlockMember& other) const { return name == other.name && type == other.type; }
};

/// One author's function in a program, with what belongs to it.
struct Stage {
    std::string entry; ///< chain entry name
    EffectPtr effect;
    const SourceInfo* source = nullptr;
    std::vector<BlockMember> members;
    std::vector<RecordedNumber> constants; ///< effect's constant parameters, then the pass's constants
    std::vector<std::string> samplers;     ///< argument names, in order

    /// The function's name: the file's name without ".glsl".
    std::string function() const;
};

Stage make_stage(const ChainEntry& entry, const RecordedPass& pass);

/// Why both can't be in one program; empty when they can. Two instances of one function share it and differ
/// in their block, so they must agree in everything that is compiled in.
std::string why_not_together(const Stage& a, const Stage& b);

enum class Encoding { none, srgb, srgb_dithered };

/// What the last pass does to the chain's colour.
struct Finish {
    Encoding encoding = Encoding::none;
    bool divide_by_alpha = false; ///< before it is encoded
};

/// How a pass's program gets its numbers, from uniform blocks or compiled in (PlanOptions::fold), and gives some: does
/// it count its texture reads (PlanOptions::count_taps)?
struct Numbers {
    int width = 0, height = 0; ///< of the pass's target
    bool folded = false, count_taps = false;
    FrameBlock frame; ///< when folded: what of it does not change from frame to frame is compiled in
};

/// The program of a fused pass: every stage's function in turn on the pixel's own colour, then the finish.
/// Texture units: 0 is the stored colour, then every stage's samplers in order.
ProgramSource assemble_compose(const std::vector<Stage>& stages, Finish finish, const Numbers& numbers);

/// The program of a pass of its own. Texture units: the stage's samplers in order.
ProgramSource assemble_fragment(const Stage& stage, int outputs, bool tiled, const Numbers& numbers);

/// A compute program that asks the effect's function, with the censuses of its inputs: slots, and whether of a depth.
struct CensusInput {
    int slot = -1;
    bool depth = false;
};
ProgramSource assemble_decision(const Stage& stage, int decision, const std::vector<CensusInput>& censuses,
                                const Numbers& numbers);

/// A compute program that counts an image (texture unit 0) into a slot (uniform location 0).
ProgramSource assemble_census(bool depth, const Numbers& numbers);
/// What the census program's one group looks at [pixels].
inline constexpr int census_group_width = 64, census_group_height = 64;

/// Names everything that is compiled in, so that equal keys have equal programs.
std::string program_key(const std::vector<Stage>& stages, std::string_view form, const Numbers& numbers);

/// Size of the uniform block without its structs, and of one stage's struct; both multiples of 16.
inline constexpr std::size_t block_head_bytes = 16;
std::size_t struct_bytes(const Stage& stage);

/// std140 bytes of the block that both programs declare at binding 1: target size, then one struct per stage.
/// Empty when they are compiled in.
std::vector<std::byte> uniform_block(const std::vector<Stage>& stages, const Numbers& numbers);

} // namespace postfx
