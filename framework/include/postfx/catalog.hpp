// The effects that were found: plugins opened, their declarations checked and copied. No OpenGL.
//
// Threads: a catalog is made and filled by one thread at a time; what is const, and every EffectInfo, is [any thread].
// Errors: postfx::Error, naming the file, and where there is one the effect and the field.
#pragma once

#include <postfx/plugin.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

enum class ParameterKind { number, integer, toggle, choice, color };

/// One parameter as declared by its effect.
struct ParameterInfo {
    std::string id;
    std::string glsl_name; ///< of the struct's member, or of the constant, in capitals
    ParameterKind kind = ParameterKind::number;
    std::string unit; ///< "m", "mm", "px", ... or ""
    std::string help;
    std::array<double, 4> default_value{};
    double minimum = 0, maximum = 1, step = 0; ///< step 0 = continuous
    std::optional<double> identity;            ///< value at which the effect does nothing
    std::vector<std::string> choices;
    bool constant = false; ///< compiled into the shader
    bool logarithmic = false;

    /// How many of the four numbers count: 3 for a color, else 1.
    int components() const { return kind == ParameterKind::color ? 3 : 1; }
    /// "float", "int", "bool", "choice" or "color".
    std::string_view kind_name() const;
};

/// A parameter's value; a choice is its index, a toggle 0 or 1.
using Value = std::array<double, 4>;

struct LevelInfo {
    std::string id;
    std::string help;
};

/// GLSL that came in a module.
struct SourceInfo {
    std::string name;
    std::string text;
    std::string path; ///< where it was at build time, may be empty
    std::string
        not_pointwise; ///< why it can't be a compose function; empty = nothing forbidden was found in it
    /// For each parameter of the effect: is it named here, or in what this includes? Others are no part of its
    /// programs, which so serve all of their values.
    std::vector<bool> names{};
};

/// Where an effect belongs in a chain, by the light that it works on.
enum class EffectStage {
    scene,            ///< scene-linear light
    scene_to_display, ///< makes display light of it: a tone map
    display,          ///< what the display shows
};
/// "scene", "scene_to_display", "display".
std::string_view stage_word(EffectStage stage);
/// By its word. Nothing when there is none.
std::optional<EffectStage> stage_by_word(std::string_view word);

/// One effect as found. Immutable; shared by chains and plans that use it.
struct EffectInfo {
    std::string id;
    std::string version;
    std::string help;
    EffectStage stage = EffectStage::scene;
    std::vector<ParameterInfo> parameters;
    std::vector<std::string> reads; ///< attachments besides the chain's colour
    std::vector<LevelInfo> levels;  ///< empty = one quality only
    int default_level = 0;
    std::vector<SourceInfo> sources;
    std::filesystem::path module_path;
    const postfx_effect* abi = nullptr;                          ///< stays mapped until the process ends
    void (*gain)(const postfx_request*, postfx_gain*) = nullptr; ///< may be absent

    /// Index into parameters; nothing if there is none of that id.
    std::optional<std::size_t> find_parameter(std::string_view parameter_id) const;
    std::vector<Value> default_values() const;
    const SourceInfo* find_source(std::string_view name) const;
};

using EffectPtr = std::shared_ptr<const EffectInfo>;

/// Effects by id, in alphabetical order.
class Catalog {
public:
    /// Where plugins are looked for, first hit by effect id wins:
    ///   1. `first`: of a program, what it was told; of an engine, the CMake package's postfx_PLUGIN_DIR;
    ///   2. the absolute directories of POSTFX_PLUGIN_PATH, between colons;
    ///   3. the user's: $XDG_DATA_HOME/postfx/plugins;
    ///   4. postfx_plugins/ beside the program and ../lib/postfx/plugins-<ABI major> from there, then the same of the
    ///      shared library that postfx is in, if it is in one;
    ///   5. lib/postfx/plugins-<ABI major> of the prefix that it was configured for.
    /// Never the current directory: empty, relative or world-writable entries are refused with a note. Throws Error for a
    /// directory of `first` that is not there.
    static Catalog discover(const std::vector<std::filesystem::path>& first = {});

    /// Open one module and add its effects. Throws Error when it is not a plugin or has another major
    /// version. An effect that declares something wrong is refused with an Error that names file, effect and
    /// field; the module's other effects are added all the same (if several are wrong, the first is thrown,
    /// the others are notes).
    void load(const std::filesystem::path& module);
    /// Check a module's declarations and add its effects, without opening anything. `origin` is for messages.
    void add(const postfx_module& module, const std::filesystem::path& origin);

    const std::vector<EffectPtr>& effects() const { return effects_; }
    /// Null when there is none.
    EffectPtr find(std::string_view id) const;
    std::vector<std::string> ids() const;
    /// What is not as it should be, one line each: directories and modules refused and why, shadowed copies; and when
    /// discover() found no effect at all, where it looked.
    const std::vector<std::string>& notes() const { return notes_; }
    /// Where discover() looked, in that order, also where nothing is.
    const std::vector<std::filesystem::path>& searched() const { return searched_; }

private:
    void scan(const std::filesystem::path& directory);
    void add(EffectPtr effect);

    std::vector<EffectPtr> effects_;
    std::vector<std::string> notes_;
    std::vector<std::filesystem::path> searched_;
};

} // namespace postfx
