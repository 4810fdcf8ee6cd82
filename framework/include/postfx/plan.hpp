// What will be drawn, as pure data. Chain + SceneFacts + PlanOptions -> Plan; no OpenGL.
#pragma once

#include <postfx/camera.hpp>
#include <postfx/chain.hpp>
#include <postfx/format.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

/// What the picture is to be.
enum class Output {
    linear,  ///< the chain's result in the working format, unencoded
    display, ///< rgba8: sRGB encoded, dithered
};

/// Bounds that hold for every pixel of the scene, known without looking at one.
struct SceneBounds {
    double nearest = 0, farthest = infinity; ///< of any surface: metres along the view axis
    double reach = infinity;                 ///< metres from the eye to the farthest surface along its ray
    double lowest = -infinity, highest = infinity; ///< of any surface: metres in the world
    /// Attachments that are zero in every pixel; "depth": nothing but sky.
    std::vector<std::string> empty;

    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// What is, as the host knows it before any pixel is drawn.
struct SceneFacts {
    int width = 0, height = 0; ///< pixels
    Camera camera;
    std::vector<std::string> attachments = {"color"}; ///< what can be provided, in any order
    SceneBounds bounds;
    /// The picture came as 8-bit codes: with nothing to do, they are not dithered.
    bool color_is_8bit = false;
};

/// What is wished of a plan: what is to come out, and how it is to be drawn.
struct PlanOptions {
    Output output = Output::display;
    Format working_format = Format::rgba16f;
    /// Display output: the colour is multiplied by alpha, its codes are not to be. Where alpha is 0 it stays as it is.
    bool divide_by_alpha = false;
    bool fuse = true; ///< false: every effect writes its own target
    /// Compile all values, sizes and the projection into the shaders: quicker passes, but whatever changes one of
    /// them makes a new program (tens of milliseconds each). For what is drawn thousands of times with the same values.
    bool fold = false;
    /// Programs count their texture reads (PassReport::taps): the same picture, more slowly. A plan whose reads can't
    /// all be counted is refused.
    bool count_taps = false;
};

/// A texture that a pass reads or writes: an attachment of the scene, or a target of the plan.
struct ImageRef {
    enum class Kind { none, attachment, target } kind = Kind::none;
    int index = -1; ///< into Plan::attachments or Plan::targets
    bool operator==(const ImageRef&) const = default;
};

/// A texture that the executor provides. Several images of the plan may share one, one after the other.
struct Target {
    int width = 0, height = 0;
    Format format = Format::rgba16f;
    std::size_t bytes() const;
};

/// What a program's shader runs on: every pixel of the target, those of listed tiles, or threads.
enum class ProgramKind { full_screen, tiles, compute };

/// A whole shader with the files that its `#line` numbers refer to. Shared by plans; `key` names its
/// text.
struct ProgramSource {
    std::string text;
    std::vector<std::string> files; ///< by source-string number
    ProgramKind kind = ProgramKind::full_screen;
    bool counts_taps = false;
    std::uint64_t key = 0; ///< hash of text
};

struct PassInput {
    std::string name; ///< of the sampler argument
    ImageRef image;
    bool linear = false;
};

/// When a pass is drawn, by the plan's decisions: if all of `live` are for their effects and all of `dead` against
/// (bits by index into Plan::decisions).
struct Term {
    std::uint32_t live = 0, dead = 0;
    bool operator==(const Term&) const = default;
};
/// If any of them holds; always if there are none.
using Condition = std::vector<Term>;

enum class PassKind {
    draw,
    census, ///< of input 0, into the slot of censuses
    decide, ///< of the decision in `slot`
};

struct Pass {
    PassKind kind = PassKind::draw;
    int slot = -1;             ///< of a census or decision
    std::vector<int> censuses; ///< slots that a decision reads
    Condition condition;
    std::string name;                 ///< "glow/down", "shade+tint+output"
    std::vector<std::string> effects; ///< chain entry names whose code is in it
    std::shared_ptr<const ProgramSource> program;
    std::vector<PassInput> inputs; ///< texture unit = index
    std::vector<ImageRef> outputs; ///< all targets of one size
    ImageRef where;                ///< tile mask; none = drawn everywhere
    int tiles_across = 0, tiles_down = 0, tile_side = 0;
    int width = 0, height = 0;
    Format format = Format::rgba16f;      ///< of the first output
    std::vector<std::byte> uniform_block; ///< std140 bytes for binding 1; empty when they are compiled in
};

enum class EffectStatus { ran, fused, skipped };
std::string_view status_name(EffectStatus status);

/// When it turns out that an effect need not run.
enum class Moment {
    configuration, ///< its values say so
    scene,         ///< what is known of the scene says so
    frame,         ///< the GPU decides, frame by frame
};
std::string_view moment_word(Moment moment);
/// By its word. Nothing when there is none.
std::optional<Moment> moment_by_word(std::string_view word);

/// Why the picture may do without an effect.
enum class SkipKind {
    exact,   ///< no bit of it changes
    code,    ///< at most one 8-bit code changes
    visible, ///< what changes is by convention not seen
    lacks,   ///< it has to: something that the effect needs is missing
};
std::string_view skip_kind_word(SkipKind kind);
/// By its word. Nothing when there is none.
std::optional<SkipKind> skip_kind_by_word(std::string_view word);

/// What became of one entry of the chain.
struct PlannedEffect {
    std::string name; ///< chain entry
    std::string id;   ///< effect
    EffectStatus status = EffectStatus::ran;
    std::optional<Moment> moment = {}; ///< when skipped
    std::optional<SkipKind> kind = {}; ///< when skipped
    /// When skipped: why. Otherwise: with what it was fused, or why not with its neighbour.
    std::string reason = {};
    int decision = -1; ///< into Plan::decisions, when the frame decides
};

/// A question to the frame: its effect is skipped where the first number found is at most the second.
struct Decision {
    SkipKind kind = SkipKind::exact; ///< of the skip; never lacks
    std::string compared, limit;     ///< names of the numbers
};

/// At most, of one plan: bits of Term.
inline constexpr std::size_t max_decisions = 32;

struct Plan {
    int width = 0, height = 0;
    std::vector<PlannedEffect> effects;
    std::vector<std::string> attachments; ///< those that some pass reads; the host need not render others
    std::vector<Target> targets;
    std::vector<Pass> passes;
    std::vector<Decision> decisions;
    int censuses = 0; ///< slots
    /// The result: the last pass's target, or an attachment when nothing is left to do.
    ImageRef picture;
    std::vector<std::string> warnings;

    std::size_t texture_bytes() const;
};

/// Makes plans. Keeps assembled shader texts between calls, so that a re-plan costs microseconds; apart from
/// that the same chain, facts and options give the same plan.
class Planner {
public:
    Planner();
    ~Planner();
    Planner(Planner&&) noexcept;
    Planner& operator=(Planner&&) noexcept;

    /// Naming the effect, throws Refusal when it refuses its values, and Error when its plan is wrong.
    Plan plan(const Chain& chain, const SceneFacts& facts, const PlanOptions& options = {});

private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

} // namespace postfx
