// Asking one effect for its passes: the host's side of postfx_builder.
#pragma once

#include <postfx/plan.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

/// Textures that one pass may read: GL 4.5 promises as many units to a fragment shader.
inline constexpr std::size_t most_pass_inputs = 16;

/// An image as one effect sees it. Handles of the ABI are indices into Recording::images plus 1.
struct RecordedImage {
    enum class Kind { color, attachment, output } kind = Kind::color;
    std::string attachment; ///< its name
    int pass = -1;          ///< into Recording::passes
    int output = 0;         ///< of that pass
    int width = 0, height = 0;
};

struct RecordedInput {
    std::string name;
    int image = -1; ///< into Recording::images
    bool linear = false;
};

struct RecordedNumber {
    std::string name;
    bool integer = false;
    int components = 1;
    std::array<double, 4> value{};
};

struct RecordedPass {
    std::string name;
    const SourceInfo* source = nullptr;
    bool compose = false;
    std::vector<RecordedInput> inputs;
    std::vector<RecordedNumber> values;
    std::vector<RecordedNumber> constants;
    std::vector<Format> formats; ///< one per output
    int width = 0, height = 0;
    int where = -1;    ///< tile mask, into Recording::images; -1: drawn everywhere
    int tile_side = 0; ///< pixels
};

struct Identity {
    Moment moment = Moment::configuration;
    SkipKind kind = SkipKind::exact;
    std::string reason;
};

/// A question to the frame; `pass` has its source, inputs and numbers.
struct RecordedDecision {
    RecordedPass pass;
    Decision decision;
};

/// What an effect answered: an identity, or passes of which the last and only the last is the compose.
struct Recording {
    std::optional<Identity> identity;
    std::optional<RecordedDecision> decision;
    std::vector<RecordedImage> images;
    std::vector<RecordedPass> passes;

    /// Does this pass sample the chain's stored colour?
    bool reads_color(const RecordedPass& pass) const;
};

/// How many 8-bit codes of the picture change, at most, with light and with shares of it.
struct Codes {
    double per_light = 0, per_share = 0;
};
/// Of the picture as it is displayed: sRGB encoded.
Codes display_codes();
/// In front of an effect, if `behind` holds behind it. Infinite if the effect does not say what it does.
Codes codes_before(const ChainEntry& entry, const SceneFacts& facts, const Codes& behind);

/// Call the effect's plan(). Naming the chain entry, throws Refusal when it refuses its values, and Error when it
/// declares something wrong.
/// `working_format`: of outputs that name none; `skip`: what it may leave out; `codes`: behind it.
Recording record(const ChainEntry& entry, const SceneFacts& facts, Format working_format, Skip skip,
                 const Codes& codes);

} // namespace postfx
