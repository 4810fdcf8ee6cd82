// What an effect's test.cpp includes: run one effect on given pixels, and its float64 reference beside it.
// Include Catch2 yourself; link postfx::testing (postfx_add_effect does it).
#pragma once

#include <postfx/postfx.hpp>

#include <concepts>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace postfx::testing {

/// What goes into one effect. Absent attachments are left out of the map.
struct Input {
    Image color; ///< 3 or 4 channels, scene-linear
    std::map<std::string, Image> attachments =
        {}; ///< "depth" (1 channel, raw samples), "normal" (3), "emission" (3), ...
    Camera camera = {};
    double time = 0;
    std::uint32_t frame = 0;
    std::uint32_t seed = 0;
};

/// A test's own enum of words, with a function word_of() beside it.
template<class T>
concept HasWord = requires(const T& thing) {
    { word_of(thing) } -> std::convertible_to<std::string_view>;
};

/// A parameter's number, or a word.
struct Setting {
    Setting() = default;
    Setting(double number) : number(number) {}
    template<std::convertible_to<std::string_view> Word>
    Setting(const Word& word) : word(word) {}
    template<HasWord Named>
    Setting(const Named& named) : word(word_of(named)) {}

    double number = 0;
    std::string word; ///< not empty: it counts and not the number
    bool operator==(const Setting&) const = default;
};

/// Parameter values by id; a choice by its index. What is not named has its default. "quality" is the level's name,
/// "skip" the word of the chain's Skip.
using Values = std::map<std::string, Setting>;

/// The names of the effect's levels; {""} if it has one quality only.
std::vector<std::string> names_of_levels(const EffectInfo& effect);
/// By its name; "" is the only quality of an effect without levels. Throws Error when the effect has no such level.
void set_level(ChainEntry& entry, std::string_view level);

/// Is there a GL 4.5 context on this machine? If not, `why` says what was found; GL tests then skip.
bool has_gl(std::string* why = nullptr);
/// Does a test that can't run without OpenGL or a window fail instead of being skipped? POSTFX_REQUIRE_GL=1 says so.
bool requires_gl();
/// What main() returns when the test can't run here, after printing why: 77, which CTest shows as skipped, or 1 if
/// OpenGL is required.
int skipped(const std::string& why);

/// Run one effect, in rgba32f working targets unless told otherwise; the result has 4 channels.
/// Uses the plugin of the catalog that the build made. Throws postfx::Error.
Image run_effect(const std::string& effect, const Input& input, const Values& values = {},
                 Format working_format = Format::rgba32f);

/// Run a chain given as YAML text.
Image run_chain(const std::string& yaml, const Input& input, Format working_format = Format::rgba32f,
                bool fuse = true);

/// The effects of this build.
const Catalog& catalog();

/// What a host would tell the planner about that input.
SceneFacts facts_of(const Input& input);
/// Plans whose pictures are compared as light.
PlanOptions linear_output(Format working_format = Format::rgba32f);

/// Draws many plans with one executor, so that programs and targets are kept; a context must be there (has_gl).
class Runner {
public:
    /// Compile and allocate. Throws Error.
    void prepare(Plan plan);
    /// Upload the input and draw the prepared plan, whose size and attachments it must have. Throws Error, also when
    /// OpenGL complained.
    Image draw(const Input& input);
    /// What the last draw() did.
    Report report() const { return executor_.report(); }

private:
    Plan plan_;
    Executor executor_;
};

/// The plan of one effect for that input (no GL).
Plan plan_effect(const std::string& effect, const Input& input, const Values& values = {});

/// Everything that a reference needs. `values` holds every declared parameter as a number (colors: id.0 .1 .2).
struct ReferenceInput {
    Image64 color;
    std::map<std::string, Image64> attachments;
    Camera camera;
    double time = 0;
    std::uint32_t frame = 0;
    std::uint32_t seed = 0;
    std::string level; ///< its name; empty if the effect has one quality only
    std::map<std::string, double> values;
    double value(const std::string& id) const;
    /// Where `level` stands in the reference's own list of names. Throws Error when it is not in it.
    int level_among(std::initializer_list<std::string_view> names) const;
};
/// The float64 reference's input for the same effect, input and values.
ReferenceInput reference_input(const std::string& effect, const Input& input, const Values& values = {});

/// Defined by the effect's reference.cpp: the same model, pixel by pixel in float64, sharing no code with the
/// GLSL. Returns 3 channels.
Image64 reference(const ReferenceInput& input);

// ---- pictures to test on

Image constant(int width, int height, std::vector<float> value);
/// Reproducible noise in [low, high], 3 channels.
Image noise(int width, int height, float low, float high, std::uint32_t seed = 1);
/// Black with one pixel of that value.
Image impulse(int width, int height, int x, int y, float value);

Image three_channels(const Image& image);
Image mirrored(const Image& image);
/// Every number, alpha too, times the factor.
Image scaled(Image image, float factor);

/// A part of a picture, pixels from the lower left corner.
struct Part {
    int x = 0, y = 0, width = 1, height = 1;
};
Image part_of(const Image& image, const Part& part);
/// What that part shows, by the camera that sees nothing else: the axis stays where it is in the scene, so it does not
/// lie in the part's middle.
Input part_of(const Input& input, const Part& part);

// ---- comparing

struct Worst {
    double absolute = 0; ///< largest |a - b|
    double relative = 0; ///< largest |a - b| / max(|b|, 1e-6)
    int x = 0, y = 0, channel = 0;
};
/// The first 3 channels of `result` against `expected`; a non-finite mismatch counts as infinity.
Worst worst_difference(const Image& result, const Image64& expected);
/// Same bits in the first 3 channels, -0 and NaN payloads included.
bool same_bits(const Image& a, const Image& b);

/// Compare with golden/<name>.png beside the test (sRGB codes). Fails with the numbers; writes the new
/// picture to the build directory. POSTFX_UPDATE_GOLDEN=1 rewrites the file instead and says so. `reason`
/// says why the tolerance.
void check_golden(const std::string& directory, const std::string& name, const Image& display_linear,
                  int max_codes, double max_differing_fraction, const std::string& reason);

} // namespace postfx::testing
