#include "yaml.hpp"

#include <base/read_file.hpp>
#include <base/yaml_scalars.hpp>
#include <base/yaml_text.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// yaml-cpp counts from 0 and has -1 for "unknown"; 0 is unknown here.
Place place_of(const YAML::Mark& mark, const std::string& file) {
    return {file, mark.line + 1, mark.column + 1, {}, {}};
}

std::string described(const YAML::Node& node) {
    switch (node.Type()) {
    case YAML::NodeType::Map:
        return "a map";
    case YAML::NodeType::Sequence:
        return "a list";
    case YAML::NodeType::Scalar:
        return fmt::format("\"{}\"", node.Scalar());
    default:
        return "nothing";
    }
}

/// Neither in quotes nor a block of text, which are never numbers. yaml-cpp tags those "!".
bool is_plain(const YAML::Node& node) {
    return node.IsScalar() && node.Tag() != "!";
}

/// Does `after` stand behind `before` with just a comma between them?
bool stand_around_comma(const YAML::Node& before, const YAML::Node& after) {
    return before.IsDefined() && is_plain(before) && is_plain(after)
           && before.Mark().line == after.Mark().line
           && before.Mark().column + static_cast<int>(before.Scalar().size()) + 1 == after.Mark().column;
}

/// `; decimals are written with a point: 0.5` when two items of a list look like one number with a comma.
std::string decimal_comma_hint(const YAML::Node& list) {
    for (std::size_t i = 0; list.IsSequence() && i + 1 < list.size(); ++i) {
        if (stand_around_comma(list[i], list[i + 1]))
            return comma_hint(list[i].Scalar(), list[i + 1].Scalar());
    }
    return "";
}

} // namespace

std::string YamlValue::found(const std::vector<std::string>& keys) const {
    return described(*node_) + (node_->IsScalar() ? colon_hint(node_->Scalar(), keys) : "");
}

void YamlValue::fail(const std::string& message) const {
    throw Error(place_of(node_->Mark(), *file_), message);
}

double YamlValue::number(Range range) const {
    const std::optional<double> found = is_plain(*node_) ? core_number(node_->Scalar()) : std::nullopt;
    if (!found || !std::isfinite(*found)) {
        fail(fmt::format("expected a number, found {}{}", described(*node_),
                         is_plain(*node_) ? number_hint(node_->Scalar()) : ""));
    }
    const double result = *found;
    if (result < range.low || result > range.high) {
        fail(fmt::format("{} is out of range, expected {} to {}", result, range.low, range.high));
    }
    return result;
}

int YamlValue::integer(Range range) const {
    const double result = number(range);
    if (result != std::floor(result)) fail(fmt::format("expected a whole number, found {}", result));
    return static_cast<int>(result);
}

bool YamlValue::toggle() const {
    if (const std::optional<bool> found = is_plain(*node_) ? core_bool(node_->Scalar()) : std::nullopt)
        return *found;
    fail(fmt::format("expected true or false, found {}{}", described(*node_),
                     is_plain(*node_) ? bool_hint(node_->Scalar()) : ""));
}

std::string YamlValue::text() const {
    if (!node_->IsScalar()) fail(fmt::format("expected a text, found {}", described(*node_)));
    return node_->Scalar();
}

std::filesystem::path YamlValue::named_file(std::string_view expected) const {
    std::filesystem::path file = folder_of(*file_) / text();
    try {
        expect_readable(file, expected);
    } catch (const Error& error) {
        fail(fmt::format("can't read {}: {}", error.place().file, error.message()));
    }
    return file;
}

std::string YamlValue::choice(const std::vector<std::string>& words) const {
    std::string word = text();
    if (std::find(words.begin(), words.end(), word) != words.end()) return word;
    fail(fmt::format("unknown word \"{}\", expected one of {}{}", word, fmt::join(words, ", "),
                     did_you_mean(word, words)));
}

glm::dvec3 YamlValue::vector(Range range) const {
    if (!is_list() || node_->size() != 3)
        fail(fmt::format("expected [x, y, z], found {}{}", described(*node_), decimal_comma_hint(*node_)));
    const auto items = list();
    return {items[0].number(range), items[1].number(range), items[2].number(range)};
}

glm::dvec2 YamlValue::pair(Range range) const {
    if (!is_list() || node_->size() != 2)
        fail(fmt::format("expected two numbers, found {}{}", described(*node_), decimal_comma_hint(*node_)));
    const auto items = list();
    return {items[0].number(range), items[1].number(range)};
}

glm::vec3 YamlValue::color(double high) const {
    if (node_->IsScalar()) return glm::vec3(static_cast<float>(number({0, high})));
    if (!is_list() || node_->size() != 3) {
        fail(fmt::format("expected a color [r, g, b] or one number, found {}{}", described(*node_),
                         decimal_comma_hint(*node_)));
    }
    return vector({0, high});
}

std::vector<YamlValue> YamlValue::list() const {
    if (!is_list()) fail(fmt::format("expected a list, found {}", described(*node_)));
    std::vector<YamlValue> items;
    for (const YAML::Node& item : *node_)
        items.emplace_back(item, file_);
    return items;
}

std::vector<std::pair<YamlValue, YamlValue>> YamlValue::entries() const {
    if (!is_map()) fail(fmt::format("expected a map, found {}", described(*node_)));
    std::vector<std::pair<YamlValue, YamlValue>> result;
    std::vector<std::string> seen;
    YAML::Node before;
    for (const auto& entry : *node_) {
        if (entry.second.IsNull() && stand_around_comma(before, entry.first))
            refuse_decimal_comma(before, entry.first);
        before.reset(entry.second);
        const YamlValue key(entry.first, file_);
        const std::string name = key.text();
        if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
            key.fail(fmt::format("\"{}\" stands here a second time", name));
        }
        seen.push_back(name);
        result.emplace_back(key, YamlValue(entry.second, file_));
    }
    return result;
}

/// {radius: 0,5} is a radius of 0 and a key 5 to YAML.
void YamlValue::refuse_decimal_comma(const YAML::Node& before, const YAML::Node& after) const {
    if (const std::string hint = comma_hint(before.Scalar(), after.Scalar()); !hint.empty()) {
        YamlValue(before, file_)
            .fail(fmt::format("expected a number, found \"{},{}\"{}", before.Scalar(), after.Scalar(), hint));
    }
}

YamlMap::YamlMap(const YamlValue& value, std::string what, std::vector<std::string> keys)
    : value_(value), what_(std::move(what)) {
    if (value.is_null()) return; // "box:" is a box with its defaults
    if (!value.is_map()) value.fail(fmt::format("expected a map, found {}", value.found(keys)));
    for (const auto& [key, content] : value.entries()) {
        const std::string name = key.text();
        if (std::find(keys.begin(), keys.end(), name) == keys.end()) {
            const std::string colon = colon_hint(name, keys);
            const std::string hint = colon.empty() ? did_you_mean(name, keys) : colon;
            key.fail(fmt::format("unknown key \"{}\" in {}{}", name, what_,
                                 hint.empty() ? fmt::format(", expected {}", fmt::join(keys, ", ")) : hint));
        }
        entries_.emplace_back(name, content);
    }
}

std::optional<YamlValue> YamlMap::find(const std::string& key) const {
    for (const auto& [name, content] : entries_) {
        if (name == key) return content;
    }
    return std::nullopt;
}

YamlValue YamlMap::at(const std::string& key) const {
    const auto found = find(key);
    if (!found) value_.fail(fmt::format("{} needs \"{}\"", what_, key));
    return *found;
}

void YamlMap::read(const std::string& key, double& target, Range range) const {
    if (const auto found = find(key)) target = found->number(range);
}

void YamlMap::read(const std::string& key, float& target, Range range) const {
    if (const auto found = find(key)) target = static_cast<float>(found->number(range));
}

void YamlMap::read(const std::string& key, int& target, Range range) const {
    if (const auto found = find(key)) target = found->integer(range);
}

void YamlMap::read(const std::string& key, std::uint32_t& target) const {
    if (const auto found = find(key)) target = static_cast<std::uint32_t>(found->integer({0, 1e9}));
}

void YamlMap::read(const std::string& key, bool& target) const {
    if (const auto found = find(key)) target = found->toggle();
}

void YamlMap::read(const std::string& key, std::string& target) const {
    if (const auto found = find(key)) target = found->text();
}

void YamlMap::read(const std::string& key, glm::dvec3& target, Range range) const {
    if (const auto found = find(key)) target = found->vector(range);
}

void YamlMap::read(const std::string& key, glm::vec3& target, Range range) const {
    if (const auto found = find(key)) target = found->vector(range);
}

void YamlMap::read(const std::string& key, glm::vec2& target, Range range) const {
    if (const auto found = find(key)) target = found->pair(range);
}

void YamlMap::read_color(const std::string& key, glm::vec3& target, double high) const {
    if (const auto found = find(key)) target = found->color(high);
}

YamlValue parse_yaml(const std::string& text, const std::string& file) {
    const YamlText source(text, file);
    source.check_characters();
    try {
        YamlValue root(YAML::Load(std::string(source.text())), std::make_shared<const std::string>(file));
        source.check_quotes();
        return root;
    } catch (const YAML::Exception& error) {
        const bool known = !error.mark.is_null();
        throw source.syntax_error(known ? static_cast<std::size_t>(error.mark.pos) : text.size(), error.msg);
    }
}

} // namespace postfx::host
