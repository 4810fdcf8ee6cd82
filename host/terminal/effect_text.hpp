// What an effect declares, in words and in JSON: for `list`, `describe` and the pages that `docs` writes.
#pragma once

#include <postfx/catalog.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace postfx::host {

using Json = nlohmann::ordered_json; // keys in the order of writing: people read it too

/// Throws Error with the nearest name.
const EffectInfo& find_effect(const Catalog& catalog, const std::string& id);

/// A value as a chain file says it: 0.5, true, natural, [1, 0.9, 0.8].
std::string value_text(const ParameterInfo& parameter, const Value& value);
/// "0 to 1", "natural, artistic", "true, false".
std::string range_text(const ParameterInfo& parameter);
/// The value at which the effect does nothing; "" when none is declared.
std::string identity_text(const ParameterInfo& parameter);

/// "scene (scene-linear light, before the tone map)".
std::string stage_text(const EffectInfo& effect);
/// "color, depth": the chain's colour is always read.
std::string reads_text(const EffectInfo& effect);

/// {"id", "version", "help", "stage", "parameters": [{"id", "type", "default", "min", "max", "step", "unit",
/// "identity", "help", "choices", "constant"}], "reads", "levels": [{"id", "help"}], "default_level",
/// "module"}. Values are numbers, booleans, words (choice) or arrays of three (color); min, max and step are
/// null for words and booleans, identity and default_level when there is none.
Json effect_json(const EffectInfo& effect);

} // namespace postfx::host
