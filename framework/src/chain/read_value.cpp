#include "chain/read_value.hpp"

#include "base/yaml_scalars.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace postfx {
namespace {

[[noreturn]] void refuse(const YamlNode& node, std::string_view subject, std::string_view expected,
                         const std::string& hint = "") {
    throw Error(node.place,
                fmt::format("{}: expected {}, found {}{}", subject, expected, node.found(), hint));
}

double read_number_in_range(const YamlNode& node, std::string_view subject, const ParameterInfo& parameter) {
    const double value = read_number(node, subject, expected_value(parameter));
    if (value < parameter.minimum || value > parameter.maximum) {
        throw Error(node.place, fmt::format("{} = {} is outside {}", subject, value, range_text(parameter)));
    }
    return value;
}

double read_integer(const YamlNode& node, std::string_view subject, const ParameterInfo& parameter) {
    const double value = read_number_in_range(node, subject, parameter);
    if (value != std::floor(value)) {
        throw Error(node.place, fmt::format("{} = {} is not whole; expected {}", subject, value,
                                            expected_value(parameter)));
    }
    return value;
}

double read_choice(const YamlNode& node, std::string_view subject, const ParameterInfo& parameter) {
    if (!node.is(YamlNode::Kind::scalar)) refuse(node, subject, expected_value(parameter));
    const auto found = std::find(parameter.choices.begin(), parameter.choices.end(), node.text);
    if (found == parameter.choices.end()) {
        throw Error(node.place, fmt::format("{}: expected {}, found {}{}", subject, expected_value(parameter),
                                            node.found(), did_you_mean(node.text, parameter.choices)));
    }
    return static_cast<double>(found - parameter.choices.begin());
}

Value read_color(const YamlNode& node, const std::string& subject, const ParameterInfo& parameter) {
    if (!node.is(YamlNode::Kind::list)) {
        const double grey = read_number_in_range(node, subject, parameter);
        return {grey, grey, grey, 0};
    }
    if (node.items.size() != 3) {
        throw Error(node.place,
                    fmt::format("{}: expected {}, found {} of them{}", subject, expected_value(parameter),
                                node.items.size(), decimal_comma_hint(node.items)));
    }
    constexpr const char* channels[] = {"red", "green", "blue"};
    Value color{};
    for (std::size_t i = 0; i < 3; ++i) {
        color[i] = read_number_in_range(node.items[i], fmt::format("{} {}", subject, channels[i]), parameter);
    }
    return color;
}

} // namespace

double read_number(const YamlNode& node, std::string_view subject, std::string_view expected) {
    const bool plain = node.is(YamlNode::Kind::scalar) && !node.quoted;
    const std::optional<double> value = plain ? core_number(node.text) : std::nullopt;
    if (!value || std::isnan(*value)) refuse(node, subject, expected, plain ? number_hint(node.text) : "");
    if (std::isinf(*value) && node.text.find_first_of("iI") == std::string::npos) {
        throw Error(node.place, fmt::format("{}: {} does not fit a 64-bit float; expected {}", subject,
                                            quote(node.text), expected));
    }
    return *value == 0 ? 0.0 : *value; // no negative zero: 1/x and sign tests in shaders see it
}

Value read_value(const YamlNode& node, const EffectInfo& effect, const ParameterInfo& parameter) {
    const std::string subject = fmt::format("{}.{}", effect.id, parameter.id);
    switch (parameter.kind) {
    case ParameterKind::number:
        return {read_number_in_range(node, subject, parameter), 0, 0, 0};
    case ParameterKind::integer:
        return {read_integer(node, subject, parameter), 0, 0, 0};
    case ParameterKind::toggle:
        return {read_toggle(node, subject) ? 1.0 : 0.0, 0, 0, 0};
    case ParameterKind::choice:
        return {read_choice(node, subject, parameter), 0, 0, 0};
    case ParameterKind::color:
        return read_color(node, subject, parameter);
    }
    throw Error(fmt::format("{} is of an unknown kind", subject));
}

bool read_toggle(const YamlNode& node, std::string_view subject) {
    const bool plain = node.is(YamlNode::Kind::scalar) && !node.quoted;
    if (const std::optional<bool> value = plain ? core_bool(node.text) : std::nullopt) return *value;
    refuse(node, subject, "true or false", plain ? bool_hint(node.text) : "");
}

std::string expected_value(const ParameterInfo& parameter) {
    switch (parameter.kind) {
    case ParameterKind::number:
        return "a number in " + range_text(parameter);
    case ParameterKind::integer:
        return "a whole number in " + range_text(parameter);
    case ParameterKind::toggle:
        return "true or false";
    case ParameterKind::choice:
        return "one of " + join(parameter.choices);
    case ParameterKind::color:
        return "[red, green, blue] or one number, each in " + range_text(parameter);
    }
    return {};
}

std::string range_text(const ParameterInfo& parameter) {
    const std::string unit = parameter.unit.empty() ? "" : fmt::format(" ({})", parameter.unit);
    return fmt::format("{}..{}{}", parameter.minimum, parameter.maximum, unit);
}

std::string join(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, ", "));
}

std::string nearest_or_all(std::string_view word, const std::vector<std::string>& known) {
    if (std::string colon = colon_hint(word, known); !colon.empty()) return colon;
    const std::string nearest = did_you_mean(word, known);
    return nearest.empty() ? "; expected one of " + join(known) : nearest;
}

std::vector<std::string> known_settings(const EffectInfo& effect, const std::vector<std::string>& reserved) {
    std::vector<std::string> known;
    for (const ParameterInfo& parameter : effect.parameters)
        known.push_back(parameter.id);
    known.insert(known.end(), reserved.begin(), reserved.end());
    return known;
}

std::string unknown_parameter(const EffectInfo& effect, std::string_view id,
                              const std::vector<std::string>& reserved) {
    const std::vector<std::string> known = known_settings(effect, reserved);
    return fmt::format("{} has no parameter {}{}", effect.id, quote(id), nearest_or_all(id, known));
}

} // namespace postfx
