// The C++ face of plugin.h: what an effect's author includes. Header only; links nothing.
//
//     static constexpr postfx::Parameter parameters[] = {
//         postfx::number("strength", 0.4).range(0, 1).identity_at(0).about("How dark the corners get"),
//     };
//     static void plan(const postfx::Request& in, postfx::Builder& out) {
//         if (in.number("strength") == 0 && out.identity("strength is 0")) return;
//         out.compose("shade.glsl");
//     }
//     static constexpr auto shade =
//         postfx::effect<plan>("shade").about("Darkens the corners").with_parameters(parameters);
//     POSTFX_MODULE(&shade)
//
// GLSL: a source `shade.glsl` defines one function named after the file. docs/write-an-effect.md has the whole story.
//     compose    vec3 shade(vec3 color, Pixel pixel, ShadeParams params [, sampler2D for each reads()])
//     fragment   vec4 blur_down(Pixel pixel, BlurDownParams params [, sampler2D ...])
//     several    void blur_down(Pixel pixel, BlurDownParams params [, sampler2D ...], out vec4 a, out vec4 b)
//     decision   vec2 shade_unlit(Census picture, ShadeUnlitParams params)
// The struct's members are the effect's dynamic parameters, then the numbers given by value() in their order.
// Constant parameters and constant()s are GLSL constants in capitals: parameter `model` of effect `shade` is
// SHADE_MODEL.
#pragma once

#include "plugin.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <limits>
#include <string>

#if __has_include(<postfx_embedded_sources.h>)
#include <postfx_embedded_sources.h> // made by postfx_add_effect() from the effect's *.glsl
#endif

namespace postfx {

// ---- declaring parameters

/// A postfx_parameter under construction; every call returns a changed copy.
struct Parameter : postfx_parameter {
    constexpr Parameter(const char* id, const char* kind) : postfx_parameter{} {
        this->struct_size = sizeof(postfx_parameter);
        this->id = id;
        this->kind = kind;
        this->unit = "";
        this->help = "";
        this->maximum = 1;
    }
    constexpr Parameter range(double minimum, double maximum, double step = 0) const {
        Parameter changed = *this;
        changed.minimum = minimum;
        changed.maximum = maximum;
        if (step > 0) changed.step = step;
        return changed;
    }
    constexpr Parameter in_unit(const char* unit) const {
        Parameter changed = *this;
        changed.unit = unit;
        return changed;
    }
    constexpr Parameter about(const char* help) const {
        Parameter changed = *this;
        changed.help = help;
        return changed;
    }
    /// The value at which the whole effect is the identity (plan() must say so too).
    constexpr Parameter identity_at(double value) const {
        Parameter changed = *this;
        changed.identity = value;
        changed.flags |= POSTFX_PARAMETER_HAS_IDENTITY;
        return changed;
    }
    /// Compile the value into the shader.
    constexpr Parameter constant() const {
        Parameter changed = *this;
        changed.flags |= POSTFX_PARAMETER_CONSTANT;
        return changed;
    }
    constexpr Parameter logarithmic() const {
        Parameter changed = *this;
        changed.flags |= POSTFX_PARAMETER_LOGARITHMIC;
        return changed;
    }
};

constexpr Parameter number(const char* id, double default_value) {
    Parameter made(id, "float");
    made.default_value[0] = default_value;
    return made;
}
constexpr Parameter integer(const char* id, int default_value) {
    Parameter made(id, "int");
    made.default_value[0] = default_value;
    made.step = 1;
    return made;
}
constexpr Parameter toggle(const char* id, bool default_value) {
    Parameter made(id, "bool");
    made.default_value[0] = default_value ? 1 : 0;
    made.step = 1;
    return made;
}
/// Scene-linear RGB.
constexpr Parameter color(const char* id, double red, double green, double blue) {
    Parameter made(id, "color");
    made.default_value[0] = red;
    made.default_value[1] = green;
    made.default_value[2] = blue;
    return made;
}
/// `choices` must be static. The value is the index.
template<std::size_t count>
constexpr Parameter choice(const char* id, const char* const (&choices)[count], int default_value = 0) {
    Parameter made(id, "choice");
    made.default_value[0] = default_value;
    made.maximum = static_cast<double>(count - 1);
    made.step = 1;
    made.choices = choices;
    made.choice_count = count;
    return made;
}

constexpr postfx_level level(const char* id, const char* help) {
    return {sizeof(postfx_level), 0, id, help};
}

// ---- planning

/// What the host asks: values, size, camera, what is there. Valid during plan().
class Request {
public:
    explicit Request(const postfx_request& request) : request_(request) {}

    /// A parameter's value. Asking for one that was not declared is a mistake of the effect's.
    double number(const char* id) const { return values(id)[0]; }
    int integer(const char* id) const { return static_cast<int>(std::lround(values(id)[0])); }
    bool toggle(const char* id) const { return values(id)[0] != 0; }
    /// Index of the chosen word.
    int choice(const char* id) const { return integer(id); }
    /// Three scene-linear values.
    const double* color(const char* id) const { return values(id); }

    int width() const { return static_cast<int>(request_.width); }
    int height() const { return static_cast<int>(request_.height); }
    /// Index into the effect's levels.
    int level() const { return static_cast<int>(request_.level); }
    const postfx_camera& camera() const { return *request_.camera; }
    bool has(const char* attachment) const {
        return is_among(request_.attachments, request_.attachment_count, attachment);
    }
    /// Bounds of the scene that the host knows without looking at pixels.
    const postfx_scene& scene() const { return *request_.scene; }
    /// At most so many 8-bit codes of the displayed picture change where this effect's output changes by that much
    /// light, or by that share of itself. Infinite if it is not known what the effects behind this one do to it.
    double codes_of_light(double change) const { return codes(change, request_.codes_per_light); }
    double codes_of_share(double change) const { return codes(change, request_.codes_per_share); }
    /// Is the attachment known to be zero in every pixel ("depth": nothing but sky)?
    bool is_empty(const char* attachment) const {
        return is_among(scene().empty, scene().empty_count, attachment);
    }

private:
    struct Undeclared : std::exception {
        explicit Undeclared(const char* id)
            : text(std::string("plan() asks for an undeclared parameter: ") + id) {}
        const char* what() const noexcept override { return text.c_str(); }
        std::string text;
    };

    static double codes(double change, double per) { return change > 0 ? change * per : 0; }
    static bool is_among(const char* const* words, std::uint32_t count, const char* word) {
        for (std::uint32_t i = 0; i < count; ++i) {
            if (std::strcmp(words[i], word) == 0) return true;
        }
        return false;
    }

    const double* values(const char* id) const {
        const auto* first = reinterpret_cast<const char*>(request_.effect->parameters);
        for (std::size_t i = 0; i < request_.effect->parameter_count; ++i) {
            const auto* parameter =
                reinterpret_cast<const postfx_parameter*>(first + i * request_.effect->parameter_stride);
            if (std::strcmp(parameter->id, id) == 0) return request_.values + 4 * i;
        }
        throw Undeclared(id);
    }

    const postfx_request& request_;
};

/// An image of the plan being made.
struct PlanImage {
    postfx_image handle = 0;
    explicit operator bool() const { return handle != 0; }
    /// The n-th output of the pass whose first output this is.
    PlanImage output(std::uint32_t n) const { return {handle + n}; }
};

/// A mistake of the effect's own. Hosts that are older than fail() are told as of values.
inline void report_mistake(const postfx_builder& builder, const char* message) {
    const bool host_knows = builder.struct_size > offsetof(postfx_builder, fail);
    (host_knows ? builder.fail : builder.refuse)(builder.context, message);
}

/// What passes and decisions have in common: images that are read, and numbers. `Self` is what calls return.
template<class Self>
class Declaration {
public:
    Declaration(const Declaration&) = delete;
    Declaration& operator=(const Declaration&) = delete;

    /// Bind `image` to the function's next sampler (decisions: census) argument. filter: "nearest" or "linear";
    /// edges are clamped.
    Self& reads(const char* name, PlanImage image, const char* filter = "linear") {
        if (input_count_ == max_inputs) return overflow("inputs");
        inputs_[input_count_++] = {sizeof(postfx_input), image.handle, name, filter};
        return self();
    }
    /// A number computed here: member `name` of the function's parameter struct.
    Self& value(const char* name, double x) { return add_number(values_, value_count_, name, "float", {x}); }
    Self& value(const char* name, double x, double y) {
        return add_number(values_, value_count_, name, "float", {x, y});
    }
    Self& value(const char* name, double x, double y, double z) {
        return add_number(values_, value_count_, name, "float", {x, y, z});
    }
    Self& value(const char* name, double x, double y, double z, double w) {
        return add_number(values_, value_count_, name, "float", {x, y, z, w});
    }
    Self& int_value(const char* name, int x) {
        return add_number(values_, value_count_, name, "int", {double(x)});
    }
    /// A number compiled in: GLSL `const int NAME` / `const float NAME`. Write NAME in capitals, with the
    /// effect's prefix.
    Self& constant(const char* name, int x) {
        return add_number(constants_, constant_count_, name, "int", {double(x)});
    }
    Self& constant(const char* name, double x) {
        return add_number(constants_, constant_count_, name, "float", {x});
    }

protected:
    Declaration(const postfx_builder& builder, const char* name) : builder_(builder), name_(name) {}
    ~Declaration() = default;

    Self& overflow(const char* what) {
        report_mistake(builder_, (std::string(name_) + " declares too many " + what).c_str());
        return self();
    }
    /// Put what was declared into `abi`, a postfx_pass or postfx_decision.
    template<class Abi>
    void fill(Abi& abi) const {
        abi.inputs = inputs_;
        abi.input_count = input_count_;
        abi.input_stride = sizeof(postfx_input);
        abi.values = values_;
        abi.value_count = value_count_;
        abi.value_stride = sizeof(postfx_number);
        abi.constants = constants_;
        abi.constant_count = constant_count_;
        abi.constant_stride = sizeof(postfx_number);
    }

    const postfx_builder& builder_;

private:
    static constexpr std::uint32_t max_inputs = 12, max_numbers = 32;

    Self& self() { return static_cast<Self&>(*this); }
    Self& add_number(postfx_number* list, std::uint32_t& count, const char* name, const char* kind,
                     std::initializer_list<double> components) {
        if (count == max_numbers) return overflow("numbers");
        postfx_number& added = list[count++];
        added = {sizeof(postfx_number), static_cast<std::uint32_t>(components.size()), name, kind, {}};
        std::size_t i = 0;
        for (double component : components)
            added.value[i++] = component;
        return self();
    }

    const char* name_;
    postfx_input inputs_[max_inputs];
    postfx_number values_[max_numbers];
    postfx_number constants_[max_numbers];
    std::uint32_t input_count_ = 0, value_count_ = 0, constant_count_ = 0;
};

/// One pass as it is declared (plan.hpp has the host's Pass). It is handed to the host when it is converted
/// to a PlanImage or goes out of scope, whichever comes first; so write it as one expression.
class PassDeclaration : public Declaration<PassDeclaration> {
public:
    PassDeclaration(const postfx_builder& builder, const char* kind, const char* name, const char* source,
                    std::uint32_t width, std::uint32_t height)
        : Declaration(builder, name) {
        pass_.struct_size = sizeof(postfx_pass);
        pass_.kind = kind;
        pass_.name = name;
        pass_.source = source;
        pass_.width = width;
        pass_.height = height;
        pass_.output_count = 1;
    }
    ~PassDeclaration() { commit(); }

    /// Size relative to the picture, rounded up, at least 1x1.
    PassDeclaration& scale(double factor) {
        return sized(scaled(pass_.width, factor), scaled(pass_.height, factor));
    }
    /// Size relative to another image of this plan, rounded up, at least 1x1.
    PassDeclaration& scale_of(PlanImage image, double factor) {
        std::uint32_t width = 1, height = 1;
        builder_.size(builder_.context, image.handle, &width, &height);
        return sized(scaled(width, factor), scaled(height, factor));
    }
    PassDeclaration& sized(std::uint32_t width, std::uint32_t height) {
        pass_.width = width;
        pass_.height = height;
        return *this;
    }
    /// One format word per output: "r8" "rg8" "rgba8" "r16f" "rg16f" "rgba16f" "r32f" "rg32f" "rgba32f"
    /// "r11g11b10f", or "" for the chain's working format (the default, one output).
    PassDeclaration& formats(std::initializer_list<const char*> words) {
        pass_.output_count = 0;
        for (const char* word : words) {
            if (pass_.output_count == max_outputs) return overflow("outputs");
            formats_[pass_.output_count++] = word;
        }
        return *this;
    }
    PassDeclaration& format(const char* word) { return formats({word}); }
    /// Draw the tiles whose texel of `mask` is not 0 in its first channel, of tile_side x tile_side pixels of this
    /// pass; 32 is a good side. Others may be drawn too; where not, the outputs are 0. Which it is must make no
    /// difference to what the effect gives.
    PassDeclaration& where(PlanImage mask, std::uint32_t tile_side) {
        pass_.where = mask.handle;
        pass_.tile_side = tile_side;
        return *this;
    }

    operator PlanImage() { return {commit()}; }

private:
    static constexpr std::uint32_t max_outputs = 4;

    static std::uint32_t scaled(std::uint32_t size, double factor) {
        return static_cast<std::uint32_t>(std::fmax(1.0, std::ceil(size * factor)));
    }
    postfx_image commit() {
        if (!committed_) {
            committed_ = true;
            fill(pass_);
            pass_.formats = formats_;
            made_ = builder_.pass(builder_.context, &pass_);
        }
        return made_;
    }

    postfx_pass pass_{};
    const char* formats_[max_outputs] = {"", "", "", ""};
    bool committed_ = false;
    postfx_image made_ = 0;
};

/// A question to the frame, handed to the host when it goes out of scope.
class DecisionDeclaration : public Declaration<DecisionDeclaration> {
public:
    DecisionDeclaration(const postfx_builder& builder, const char* kind, const char* source,
                        const char* compared, const char* limit)
        : Declaration(builder, source) {
        decision_.struct_size = sizeof(postfx_decision);
        decision_.kind = kind;
        decision_.source = source;
        decision_.compared = compared;
        decision_.limit = limit;
    }
    ~DecisionDeclaration() {
        fill(decision_);
        builder_.decide(builder_.context, &decision_);
    }

private:
    postfx_decision decision_{};
};

/// What the effect answers: identity(), or passes and one compose().
class Builder {
public:
    Builder(const postfx_builder& builder, const postfx_request& request)
        : builder_(builder), request_(request) {}

    /// These values make the effect change nothing, bit for bit. True: it is skipped, so return. False: the chain
    /// is to run all the same, to prove just that; go on.
    [[nodiscard]] bool identity(const char* reason) {
        return builder_.identity(builder_.context, "configuration", "exact", reason) != 0;
    }
    /// The scene does not call for the effect. kind: "exact", "code" (at most one 8-bit code) or "visible". True: it
    /// is skipped, so return. False: the chain does not allow skips of this kind.
    [[nodiscard]] bool not_called_for(const char* kind, const std::string& reason) {
        return builder_.identity(builder_.context, "scene", kind, reason.c_str()) != 0;
    }
    /// Something is missing without which the effect can't do anything; return after it.
    void lacks(const char* reason) { builder_.lacks(builder_.context, reason); }
    /// Let the frame decide: `source` has vec2 f(Census of each reads(), params); the effect is skipped in frames
    /// where the first number is not above the second. `compared` and `limit` name them. At most once, before the
    /// passes.
    DecisionDeclaration skip_when(const char* kind, const char* source, const char* compared,
                                  const char* limit) {
        return {builder_, kind, source, compared, limit};
    }
    /// These values can't be used together; `message` says why and what would do.
    void refuse(const char* message) { builder_.refuse(builder_.context, message); }

    /// The stored picture as it reaches this effect. A pass that reads it ends fusion with what comes before.
    PlanImage color() { return {builder_.color(builder_.context)}; }
    /// "depth", "normal", "emission", "ambient"; empty when the host has none.
    PlanImage attachment(const char* name) { return {builder_.attachment(builder_.context, name)}; }

    PassDeclaration pass(const char* name, const char* source) {
        return {builder_, "fragment", name, source, request_.width, request_.height};
    }
    /// The effect's function of its own pixel; exactly one, declared last. If it reads color() as well, it
    /// samples the stored picture at displaced points and can only stand first in a fused pass.
    PassDeclaration compose(const char* source) {
        return {builder_, "compose", "compose", source, request_.width, request_.height};
    }

private:
    const postfx_builder& builder_;
    const postfx_request& request_;
};

/// Changes of a picture that stay below this [8-bit codes] may be left out under the kind "code": ten effects of one
/// chain may do so, and together change no code by more than one.
inline constexpr double negligible_codes = 0.1;

// ---- declaring the effect

/// What an effect does to small changes of the light that comes in: see postfx_gain.
struct Gain {
    double share_to_share = 1, light_to_light = 1, share_to_light = 0;
    static constexpr Gain unknown() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {infinity, infinity, infinity};
    }
};

template<Gain (*gain)(const Request&)>
void gain_entry(const postfx_request* request, postfx_gain* out) noexcept {
    Gain found = Gain::unknown();
    try {
        found = gain(Request(*request));
    } catch (...) { // such as a parameter that was not declared; plan() will tell
    }
    out->share_to_share = found.share_to_share;
    out->light_to_light = found.light_to_light;
    out->share_to_light = found.share_to_light;
}

/// Of effects that average light, take some away or add some that does not depend on it.
inline Gain unit_gain(const Request&) {
    return {};
}

/// A postfx_effect under construction; every call returns a changed copy.
struct Effect : postfx_effect {
    constexpr explicit Effect(const char* id) : postfx_effect{} {
        this->struct_size = sizeof(postfx_effect);
        this->id = id;
        this->version = "1.0.0";
        this->help = "";
        this->stage = "scene";
    }
    constexpr Effect about(const char* help) const {
        Effect changed = *this;
        changed.help = help;
        return changed;
    }
    constexpr Effect versioned(const char* version) const {
        Effect changed = *this;
        changed.version = version;
        return changed;
    }
    /// "scene" (default), "scene_to_display" or "display".
    constexpr Effect at_stage(const char* stage) const {
        Effect changed = *this;
        changed.stage = stage;
        return changed;
    }
    /// How the effect passes on small changes. Without it, effects in front of it must be `exact` to be skipped.
    template<Gain (*gain)(const Request&)>
    constexpr Effect with_gain() const {
        Effect changed = *this;
        changed.gain = gain_entry<gain>;
        return changed;
    }
    /// A change comes out no larger than it went in, neither as light nor as a share of it.
    constexpr Effect without_amplifying() const { return with_gain<unit_gain>(); }
    template<class P, std::size_t count>
    constexpr Effect with_parameters(const P (&parameters)[count]) const {
        Effect changed = *this;
        changed.parameters = parameters;
        changed.parameter_count = count;
        changed.parameter_stride = sizeof(P);
        return changed;
    }
    /// Attachments besides the chain's colour that plan() may ask for.
    template<std::size_t count>
    constexpr Effect reading(const char* const (&attachments)[count]) const {
        Effect changed = *this;
        changed.reads = attachments;
        changed.read_count = count;
        return changed;
    }
    template<std::size_t count>
    constexpr Effect with_levels(const postfx_level (&levels)[count], std::uint32_t default_level) const {
        Effect changed = *this;
        changed.levels = levels;
        changed.level_count = count;
        changed.level_stride = sizeof(postfx_level);
        changed.default_level = default_level;
        return changed;
    }
};

template<void (*plan)(const Request&, Builder&)>
std::int32_t plan_entry(const postfx_request* request, const postfx_builder* builder) noexcept {
    try {
        Builder out(*builder, *request);
        plan(Request(*request), out);
        return 0;
    } catch (const std::exception& error) {
        report_mistake(*builder, error.what());
    } catch (...) {
        report_mistake(*builder, "plan() threw something that is no std::exception");
    }
    return 1;
}

template<void (*plan)(const Request&, Builder&)>
constexpr Effect effect(const char* id) {
    Effect made(id);
    made.plan = plan_entry<plan>;
    return made;
}

} // namespace postfx

/// Export a module with the named effects (static constexpr postfx::Effect objects).
#define POSTFX_MODULE(...)                                                                                   \
    namespace {                                                                                              \
    constexpr const postfx_effect* postfx_module_effects[] = {__VA_ARGS__};                                  \
    }                                                                                                        \
    extern "C" __attribute__((visibility("default"))) constinit const postfx_module postfx_module_v1 = {     \
        sizeof(postfx_module),                                                                               \
        POSTFX_ABI_MAJOR,                                                                                    \
        POSTFX_ABI_MINOR,                                                                                    \
        sizeof(postfx_module_effects) / sizeof(postfx_module_effects[0]),                                    \
        postfx_module_effects,                                                                               \
        postfx_embedded_sources,                                                                             \
        sizeof(postfx_embedded_sources) / sizeof(postfx_embedded_sources[0]),                                \
        sizeof(postfx_source)};
