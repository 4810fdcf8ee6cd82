#include "effect_text.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace postfx::host {
namespace {

const std::string& choice_word(const ParameterInfo& parameter, double index) {
    return parameter.choices.at(static_cast<std::size_t>(std::lround(index)));
}

/// Whole numbers without ".0", as people write them.
Json number_json(double value) {
    constexpr double exactly_whole_below = 9007199254740992.0; // 2^53
    const bool whole = std::floor(value) == value && std::abs(value) < exactly_whole_below;
    return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

bool has_range(const ParameterInfo& parameter) {
    return parameter.kind != ParameterKind::toggle && parameter.kind != ParameterKind::choice;
}

Json value_json(const ParameterInfo& parameter, const Value& value) {
    switch (parameter.kind) {
    case ParameterKind::toggle:
        return value[0] != 0;
    case ParameterKind::choice:
        return choice_word(parameter, value[0]);
    case ParameterKind::color:
        return {number_json(value[0]), number_json(value[1]), number_json(value[2])};
    default:
        return number_json(value[0]);
    }
}

/// The identity is one number, which for a color stands for all its channels.
Value identity_value(double identity) {
    return {identity, identity, identity, identity};
}

Json parameter_json(const ParameterInfo& parameter) {
    const auto bound = [&](double number) { return has_range(parameter) ? number_json(number) : Json(); };
    return {
        {"id", parameter.id},
        {"type", parameter.kind_name()},
        {"default", value_json(parameter, parameter.default_value)},
        {"min", bound(parameter.minimum)},
        {"max", bound(parameter.maximum)},
        {"step", bound(parameter.step)},
        {"unit", parameter.unit},
        {"identity",
         parameter.identity ? value_json(parameter, identity_value(*parameter.identity)) : Json()},
        {"help", parameter.help},
        {"choices", parameter.choices},
        {"constant", parameter.constant},
    };
}

} // namespace

const EffectInfo& find_effect(const Catalog& catalog, const std::string& id) {
    if (const EffectPtr effect = catalog.find(id)) return *effect;
    throw Error(fmt::format("no effect \"{}\"{} (postfx list effects tells them all)", id,
                            did_you_mean(id, catalog.ids())));
}

std::string value_text(const ParameterInfo& parameter, const Value& value) {
    switch (parameter.kind) {
    case ParameterKind::toggle:
        return value[0] != 0 ? "true" : "false";
    case ParameterKind::choice:
        return choice_word(parameter, value[0]);
    case ParameterKind::color:
        return fmt::format("[{}, {}, {}]", value[0], value[1], value[2]);
    default:
        return fmt::format("{}", value[0]);
    }
}

std::string range_text(const ParameterInfo& parameter) {
    if (parameter.kind == ParameterKind::toggle) return "true, false";
    if (parameter.kind == ParameterKind::choice) return fmt::format("{}", fmt::join(parameter.choices, ", "));
    return fmt::format("{} to {}", parameter.minimum, parameter.maximum);
}

std::string identity_text(const ParameterInfo& parameter) {
    return parameter.identity ? value_text(parameter, identity_value(*parameter.identity)) : "";
}

std::string stage_text(const EffectInfo& effect) {
    switch (effect.stage) {
    case EffectStage::scene:
        return "scene (scene-linear light, before the tone map)";
    case EffectStage::scene_to_display:
        return "scene_to_display (from scene-linear light to the display)";
    case EffectStage::display:
        return "display (what the display shows, after the tone map)";
    }
    return "";
}

std::string reads_text(const EffectInfo& effect) {
    std::string text = "color";
    for (const std::string& attachment : effect.reads)
        text += ", " + attachment;
    return text;
}

Json effect_json(const EffectInfo& effect) {
    Json parameters = Json::array(), levels = Json::array();
    for (const ParameterInfo& parameter : effect.parameters)
        parameters.push_back(parameter_json(parameter));
    for (const LevelInfo& level : effect.levels)
        levels.push_back({{"id", level.id}, {"help", level.help}});
    return {
        {"id", effect.id},
        {"version", effect.version},
        {"help", effect.help},
        {"stage", stage_word(effect.stage)},
        {"parameters", parameters},
        {"reads", effect.reads},
        {"levels", levels},
        {"default_level", effect.levels.empty() ? Json() : Json(effect.levels.at(effect.default_level).id)},
        {"module", effect.module_path.string()},
    };
}

} // namespace postfx::host
