// Parameter values, checked against their declarations.
#pragma once

#include <chain/yaml_document.hpp>
#include <postfx/catalog.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace postfx {

/// The value that `node` gives to a parameter. Throws Error at the node, saying what was expected, when it
/// has another type, is not finite, not whole or out of range.
Value read_value(const YamlNode& node, const EffectInfo& effect, const ParameterInfo& parameter);

/// A bool of YAML's core schema; words that other YAMLs take for one are refused with the one meant. `subject` names the value in messages.
bool read_toggle(const YamlNode& node, std::string_view subject);

/// A number of YAML's core schema, infinite ones among them, but not .nan. `subject` and `expected` are for messages.
double read_number(const YamlNode& node, std::string_view subject, std::string_view expected);

/// What a value must be: "a number in 0..4 (stops)", "true or false", "one of round, square".
std::string expected_value(const ParameterInfo& parameter);

/// "0..1 (height)"
std::string range_text(const ParameterInfo& parameter);

/// "a, b, c"
std::string join(const std::vector<std::string>& words);

/// The end of a message about an unknown word: that a colon is missing in it, the nearest of the known ones, else all of
/// them.
std::string nearest_or_all(std::string_view word, const std::vector<std::string>& known);

/// The effect's parameters and the `reserved` keys.
std::vector<std::string> known_settings(const EffectInfo& effect, const std::vector<std::string>& reserved);

/// `blur has no parameter "radus"; did you mean "radius"?`; `reserved` are keys known besides the
/// parameters.
std::string unknown_parameter(const EffectInfo& effect, std::string_view id,
                              const std::vector<std::string>& reserved = {});

} // namespace postfx
