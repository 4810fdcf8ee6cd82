#include <plugin/declarations.hpp>

#include <base/words.hpp>
#include <plugin/pointwise.hpp>
#include <plugin/uncomment.hpp>

#include <postfx/attachment.hpp>
#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace postfx {
namespace {

constexpr std::array reserved_ids = {"enabled", "quality", "pin", "name"};
constexpr Words<3> stage_words = {"scene", "scene_to_display", "display"};
constexpr std::array<std::pair<std::string_view, ParameterKind>, 5> kinds = {{
    {"float", ParameterKind::number},
    {"int", ParameterKind::integer},
    {"bool", ParameterKind::toggle},
    {"choice", ParameterKind::choice},
    {"color", ParameterKind::color},
}};

/// Says what is wrong with a declaration, always in the same form.
struct Complaint {
    std::filesystem::path origin;
    std::string effect;

    template<class... Args>
    [[noreturn]] void operator()(fmt::format_string<Args...> format, Args&&... args) const {
        throw Error(Place{.file = origin.string(), .effect = effect},
                    fmt::format(format, std::forward<Args>(args)...));
    }
};

bool is_id(std::string_view id) {
    const auto legal = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    return !id.empty() && id.size() <= 63 && id[0] >= 'a' && id[0] <= 'z'
           && std::all_of(id.begin(), id.end(), legal) && id.find("__") == std::string::npos
           && !id.starts_with("gl_");
}

std::string text_or_empty(const char* text) {
    return text ? text : "";
}

/// What kinds that are whole numbers ask of their range and default.
void check_whole(const ParameterInfo& info, const Complaint& complain) {
    if (info.kind == ParameterKind::number || info.kind == ParameterKind::color) return;
    if (info.kind == ParameterKind::integer) {
        using Limits = std::numeric_limits<std::int32_t>;
        if (info.minimum < Limits::min() || info.maximum > Limits::max()) {
            complain("parameter {} of kind int has the range {}..{}, more than 32 bits", info.id,
                     info.minimum, info.maximum);
        }
    } else {
        const double last =
            info.kind == ParameterKind::toggle ? 1 : static_cast<double>(info.choices.size()) - 1;
        if (info.minimum != 0 || info.maximum != last) {
            complain("parameter {} of kind {} has the range {}..{}, not 0..{}", info.id, info.kind_name(),
                     info.minimum, info.maximum, last);
        }
    }
    if (info.default_value[0] != std::round(info.default_value[0])) {
        complain("parameter {} of kind {} has the default {}", info.id, info.kind_name(),
                 info.default_value[0]);
    }
}

ParameterInfo read_parameter(const postfx_parameter& declared, const Complaint& complain) {
    ParameterInfo info;
    info.id = text_or_empty(declared.id);
    if (!is_id(info.id)) complain("parameter id \"{}\" is not [a-z][a-z0-9_]*", info.id);
    if (std::find(reserved_ids.begin(), reserved_ids.end(), info.id) != reserved_ids.end()) {
        complain("parameter id \"{}\" is reserved", info.id);
    }
    const std::string kind = text_or_empty(declared.kind);
    const auto known =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == kind; });
    if (known == kinds.end()) complain("parameter {} has the unknown kind \"{}\"", info.id, kind);
    info.kind = known->second;
    info.unit = text_or_empty(declared.unit);
    info.help = text_or_empty(declared.help);
    info.minimum = declared.minimum;
    info.maximum = declared.maximum;
    info.step = declared.step;
    info.constant = declared.flags & POSTFX_PARAMETER_CONSTANT;
    info.logarithmic = declared.flags & POSTFX_PARAMETER_LOGARITHMIC;
    if (!std::isfinite(info.minimum) || !std::isfinite(info.maximum) || info.minimum >= info.maximum) {
        complain("parameter {} has the range {}..{}", info.id, info.minimum, info.maximum);
    }
    if (info.logarithmic && info.minimum <= 0)
        complain("parameter {} is logarithmic but may be 0 or less", info.id);
    if (info.constant && info.kind == ParameterKind::color) complain("color {} can't be a constant", info.id);
    for (int i = 0; i < info.components(); ++i) {
        info.default_value[i] = declared.default_value[i];
        if (!(info.default_value[i] >= info.minimum && info.default_value[i] <= info.maximum)) {
            complain("parameter {} has the default {} outside its range {}..{}", info.id,
                     info.default_value[i], info.minimum, info.maximum);
        }
    }
    if (declared.flags & POSTFX_PARAMETER_HAS_IDENTITY) {
        info.identity = declared.identity;
        if (!(*info.identity >= info.minimum && *info.identity <= info.maximum)) {
            complain("parameter {} has its identity {} outside its range", info.id, *info.identity);
        }
    }
    for (std::uint32_t i = 0; i < declared.choice_count; ++i) {
        info.choices.push_back(text_or_empty(declared.choices[i]));
        if (info.choices.back().empty()) complain("parameter {} has a choice without a name", info.id);
    }
    if ((info.kind == ParameterKind::choice) == info.choices.empty()) {
        complain("parameter {} of kind {} has {} choices", info.id, kind, info.choices.size());
    }
    check_whole(info, complain);
    return info;
}

/// A missing field of a grown array would be read from the next element: a stride below the oldest size is a
/// bug.
void check_stride(const char* what, std::uint32_t count, std::uint32_t stride, std::size_t least,
                  const Complaint& complain) {
    if (count > 0 && stride < least)
        complain("{} have a stride of {} bytes, at least {} expected", what, stride, least);
}

std::string glsl_name(const std::string& effect, const ParameterInfo& parameter) {
    if (!parameter.constant) return parameter.id;
    std::string name = effect + "_" + parameter.id;
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    return name;
}

/// One that an effect declares; the chain's colour needs no declaration.
bool is_side_attachment(std::string_view name) {
    return find_attachment(name) && name != known_attachments.front().name;
}

bool has_word(std::string_view text, std::string_view word) {
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        const bool begins = at == 0 || !is_word_character(text[at - 1]);
        const bool ends = end == text.size() || !is_word_character(text[end]);
        if (begins && ends) return true;
    }
    return false;
}

/// `source` and what it includes of its module, directly or not.
std::vector<const SourceInfo*> with_included(const SourceInfo& source, const std::vector<SourceInfo>& all) {
    std::vector<const SourceInfo*> found = {&source};
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (const SourceInfo& other : all) {
            const bool is_quoted =
                found[i]->text.find(fmt::format("\"{}\"", other.name)) != std::string::npos;
            if (is_quoted && std::find(found.begin(), found.end(), &other) == found.end())
                found.push_back(&other);
        }
    }
    return found;
}

std::vector<bool> names_of(const SourceInfo& source, const std::vector<SourceInfo>& all,
                           const std::vector<ParameterInfo>& parameters) {
    const std::vector<const SourceInfo*> texts = with_included(source, all);
    std::vector<bool> names;
    for (const ParameterInfo& parameter : parameters) {
        names.push_back(std::any_of(texts.begin(), texts.end(), [&](const SourceInfo* text) {
            return has_word(text->text, parameter.glsl_name);
        }));
    }
    return names;
}

} // namespace

std::string_view stage_word(EffectStage stage) {
    return word_among(stage_words, stage);
}

std::optional<EffectStage> stage_by_word(std::string_view word) {
    return value_among<EffectStage>(stage_words, word);
}

std::vector<SourceInfo> read_sources(const postfx_module& module, const std::filesystem::path& origin) {
    const Complaint complain{origin, ""};
    check_stride("sources", module.source_count, module.source_stride, sizeof(postfx_source), complain);
    std::vector<SourceInfo> sources;
    for (std::uint32_t i = 0; i < module.source_count; ++i) {
        const auto source = abi_element(module.sources, module.source_stride, i);
        SourceInfo info{text_or_empty(source.name), text_or_empty(source.text), text_or_empty(source.path),
                        ""};
        info.not_pointwise = why_not_pointwise(info.text);
        sources.push_back(std::move(info));
    }
    return sources;
}

EffectInfo read_effect(const postfx_effect& declared, const std::vector<SourceInfo>& sources,
                       const std::filesystem::path& origin) {
    Complaint complain{origin, text_or_empty(declared.id)};
    if (declared.struct_size < offsetof(postfx_effect, plan) + sizeof(declared.plan)) {
        complain("its description has {} bytes; this is older than ABI 1.0", declared.struct_size);
    }
    const auto effect = copy_abi<postfx_effect>(&declared);
    if (!is_id(complain.effect)) complain("effect id \"{}\" is not [a-z][a-z0-9_]*", complain.effect);
    if (effect.min_host_minor > POSTFX_ABI_MINOR) {
        complain("needs ABI {}.{}, this is {}.{}", POSTFX_ABI_MAJOR, effect.min_host_minor, POSTFX_ABI_MAJOR,
                 POSTFX_ABI_MINOR);
    }
    if (!effect.plan) complain("has no plan function");

    EffectInfo info;
    info.id = complain.effect;
    info.version = text_or_empty(effect.version);
    info.help = text_or_empty(effect.help);
    info.sources = sources;
    info.module_path = origin;
    info.abi = &declared;
    info.gain = effect.gain;
    const std::string stage = text_or_empty(effect.stage);
    const std::optional<EffectStage> known_stage = stage_by_word(stage);
    if (!known_stage) complain("has the unknown stage \"{}\"", stage);
    info.stage = *known_stage;
    check_stride("parameters", effect.parameter_count, effect.parameter_stride, sizeof(postfx_parameter),
                 complain);
    for (std::uint32_t i = 0; i < effect.parameter_count; ++i) {
        ParameterInfo parameter =
            read_parameter(abi_element(effect.parameters, effect.parameter_stride, i), complain);
        if (info.find_parameter(parameter.id)) complain("declares the parameter {} twice", parameter.id);
        parameter.glsl_name = glsl_name(info.id, parameter);
        info.parameters.push_back(std::move(parameter));
    }
    for (SourceInfo& source : info.sources)
        source.names = names_of(source, sources, info.parameters);
    for (std::uint32_t i = 0; i < effect.read_count; ++i) {
        info.reads.push_back(text_or_empty(effect.reads[i]));
        if (!is_side_attachment(info.reads.back()))
            complain("reads the unknown attachment \"{}\"", info.reads.back());
    }
    check_stride("levels", effect.level_count, effect.level_stride, sizeof(postfx_level), complain);
    for (std::uint32_t i = 0; i < effect.level_count; ++i) {
        const auto level = abi_element(effect.levels, effect.level_stride, i);
        info.levels.push_back({text_or_empty(level.id), text_or_empty(level.help)});
    }
    info.default_level = static_cast<int>(effect.default_level);
    if (effect.level_count > 0 && effect.default_level >= effect.level_count) {
        complain("has the default level {} of {}", effect.default_level, effect.level_count);
    }
    return info;
}

} // namespace postfx
