#include <postfx/chain.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace postfx {
namespace {

using Json = nlohmann::ordered_json; // keys in the order of writing: the schema is read by people too

/// Whole numbers are written without ".0", as people write them.
Json number(double value) {
    constexpr double exactly_whole_below = 9007199254740992.0; // 2^53
    const bool whole = std::floor(value) == value && std::abs(value) < exactly_whole_below;
    return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json within_range(std::string_view type, const ParameterInfo& parameter) {
    return {{"type", type}, {"minimum", number(parameter.minimum)}, {"maximum", number(parameter.maximum)}};
}

Json color_default(const ParameterInfo& parameter) {
    Json channels = Json::array();
    for (std::size_t i = 0; i < 3; ++i)
        channels.push_back(number(parameter.default_value[i]));
    return channels;
}

/// Type and range of a parameter's value, and its default.
Json value_schema(const ParameterInfo& parameter) {
    const double first = parameter.default_value[0];
    Json schema;
    switch (parameter.kind) {
    case ParameterKind::number:
        schema = within_range("number", parameter);
        schema["default"] = number(first);
        break;
    case ParameterKind::integer:
        schema = within_range("integer", parameter);
        schema["default"] = number(first);
        break;
    case ParameterKind::toggle:
        schema = {{"type", "boolean"}, {"default", first != 0}};
        break;
    case ParameterKind::choice:
        schema = {{"type", "string"},
                  {"enum", parameter.choices},
                  {"default", parameter.choices.at(static_cast<std::size_t>(first))}};
        break;
    case ParameterKind::color: {
        const Json channel = within_range("number", parameter);
        const Json three = {{"type", "array"}, {"items", channel}, {"minItems", 3}, {"maxItems", 3}};
        schema = {{"anyOf", Json::array({three, channel})}, {"default", color_default(parameter)}};
        break;
    }
    }
    return schema;
}

/// JSON Schema has no word for a unit: it stands in the description for people and in "x-unit" for programs.
Json parameter_schema(const ParameterInfo& parameter) {
    Json schema;
    schema["description"] =
        parameter.unit.empty() ? parameter.help : fmt::format("{} ({})", parameter.help, parameter.unit);
    schema.update(value_schema(parameter));
    if (!parameter.unit.empty()) schema["x-unit"] = parameter.unit;
    return schema;
}

/// Of `quality` and `pin`.
Json level_schema(const EffectInfo& effect, std::string description) {
    Json words = Json::array();
    for (const LevelInfo& level : effect.levels) {
        words.push_back(level.id);
        description += fmt::format(" {}: {}.", level.id, level.help);
    }
    return {{"description", description}, {"type", "string"}, {"enum", words}};
}

/// The map of an effect's settings.
Json effect_schema(const EffectInfo& effect) {
    Json settings = Json::object();
    for (const ParameterInfo& parameter : effect.parameters)
        settings[parameter.id] = parameter_schema(parameter);
    settings["enabled"] = {
        {"description", "false leaves the effect out"}, {"type", "boolean"}, {"default", true}};
    if (!effect.levels.empty()) {
        settings["quality"] = level_schema(effect, "Quality against time; a budget may change it.");
        settings["quality"]["default"] = effect.levels.at(static_cast<std::size_t>(effect.default_level)).id;
        settings["pin"] = level_schema(effect, "Quality that no budget changes.");
    }
    settings["name"] = {{"description", "What the rest of the program calls this entry; unique in the chain"},
                        {"type", "string"},
                        {"pattern", "^[a-z][a-z0-9_]*$"}};
    return {{"description", effect.help},
            {"type", {"object", "null"}},
            {"properties", settings},
            {"not", {{"type", "object"}, {"required", {"quality", "pin"}}}},
            {"additionalProperties", false}};
}

Json budget_schema() {
    const auto limit = [](std::string_view description) {
        return Json{{"description", description}, {"type", "number"}, {"exclusiveMinimum", 0}};
    };
    return {{"description",
             "Levels are chosen by measured curves: the least error within a time, or the least time within "
             "an error"},
            {"type", "object"},
            {"properties",
             {{"ms", limit("Milliseconds for the whole chain")},
              {"error", limit("Relative root mean square, all effects together")}}},
            {"minProperties", 1},
            {"maxProperties", 1},
            {"additionalProperties", false}};
}

/// An item of `effects`: the effect's id alone, or a map from the id to its settings.
Json item_schema(const Catalog& catalog) {
    Json by_id = Json::object();
    for (const EffectPtr& effect : catalog.effects())
        by_id[effect->id] = {{"$ref", "#/$defs/" + effect->id}};
    const Json with_settings = {{"type", "object"},
                                {"properties", by_id},
                                {"minProperties", 1},
                                {"maxProperties", 1},
                                {"additionalProperties", false}};
    return {{"anyOf", Json::array({{{"enum", catalog.ids()}}, with_settings})}};
}

/// Overrides go by entry name, and a name does not tell the effect: the settings of any effect pass.
Json override_schema(const Catalog& catalog) {
    Json any = Json::array();
    for (const EffectPtr& effect : catalog.effects())
        any.push_back({{"$ref", "#/$defs/" + effect->id}});
    if (any.empty()) return false;
    return {{"anyOf", any}, {"not", {{"type", "object"}, {"required", {"name"}}}}};
}

} // namespace

std::string chain_schema(const Catalog& catalog) {
    Json definitions = Json::object();
    for (const EffectPtr& effect : catalog.effects())
        definitions[effect->id] = effect_schema(*effect);

    const Json properties = {
        {"include",
         {{"description", "Another chain file, relative to this one; its effects come first"},
          {"type", "string"},
          {"minLength", 1}}},
        {"overrides",
         {{"description", "Changed settings of included effects, by entry name"},
          {"type", {"object", "null"}},
          {"additionalProperties", override_schema(catalog)}}},
        {"skip",
         {{"description",
           "Work that is not called for is left out if that changes: nothing (all runs), exact (no "
           "bit), code (at most one 8-bit code), visible (what by convention is not seen)"},
          {"type", "string"},
          {"enum", {"nothing", "exact", "code", "visible"}},
          {"default", skip_word(Chain{}.skip)}}},
        {"budget", budget_schema()},
        {"effects",
         {{"description", "The effects in the order in which they are applied"},
          {"type", {"array", "null"}},
          {"maxItems", max_chain_entries},
          {"items", item_schema(catalog)}}},
    };
    const Json schema = {
        {"$schema", "https://json-schema.org/draft/2020-12/schema"},
        {"title", "postfx chain"},
        {"description", "Which post-processing effects are applied, in which order, with which values"},
        {"type", "object"},
        {"properties", properties},
        {"anyOf", Json::array({{{"required", {"effects"}}}, {{"required", {"include"}}}})},
        {"dependentRequired", {{"overrides", {"include"}}}},
        {"additionalProperties", false},
        {"$defs", definitions},
    };
    // A plugin's help may hold any bytes; what is no UTF-8 becomes U+FFFD instead of an exception.
    return schema.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace postfx
