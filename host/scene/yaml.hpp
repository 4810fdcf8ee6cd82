// Strict reading of YAML: every mistake is one Error with file:line:column and what was expected.
#pragma once

#include <glm/glm.hpp>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace postfx::host {

struct Range {
    double low, high;
};

/// A value of a document, with the name of its file. Throws Error from every reading function.
class YamlValue {
public:
    YamlValue(const YAML::Node& node, std::shared_ptr<const std::string> file)
        : node_(std::make_shared<const YAML::Node>(node)), file_(std::move(file)) {}

    [[noreturn]] void fail(const std::string& message) const;
    const std::string& file() const { return *file_; }

    bool is_map() const { return node_->IsMap(); }
    bool is_list() const { return node_->IsSequence(); }
    bool is_null() const { return node_->IsNull(); }

    double number(Range range) const;
    int integer(Range range) const;
    bool toggle() const;
    std::string text() const;
    /// The file of that name, seen from the document's own folder; `expected` says what it ought to be. It is there and
    /// no folder.
    std::filesystem::path named_file(std::string_view expected) const;
    /// One of these words.
    std::string choice(const std::vector<std::string>& words) const;
    /// [x, y, z]; every number within range.
    glm::dvec3 vector(Range range) const;
    glm::dvec2 pair(Range range) const;
    /// [r, g, b], or one number for grey.
    glm::vec3 color(double high) const;
    /// What a message says was found in place of a map with these keys.
    std::string found(const std::vector<std::string>& keys) const;
    std::vector<YamlValue> list() const;
    /// The entries of a map in the file's order; a key that stands there twice is an error.
    std::vector<std::pair<YamlValue, YamlValue>> entries() const;

private:
    void refuse_decimal_comma(const YAML::Node& before, const YAML::Node& after) const;

    /// Behind a pointer because assigning a YAML::Node changes the document that it stands in.
    std::shared_ptr<const YAML::Node> node_;
    std::shared_ptr<const std::string> file_;
};

/// A map of which all keys are known beforehand.
class YamlMap {
public:
    /// `what` names the thing in messages: `unknown key "sise" in box`.
    YamlMap(const YamlValue& value, std::string what, std::vector<std::string> keys);

    std::optional<YamlValue> find(const std::string& key) const;
    /// An error when it is missing.
    YamlValue at(const std::string& key) const;
    bool has(const std::string& key) const { return find(key).has_value(); }
    const YamlValue& value() const { return value_; }

    // What is not there stays as it is.
    void read(const std::string& key, double& target, Range range) const;
    void read(const std::string& key, float& target, Range range) const;
    void read(const std::string& key, int& target, Range range) const;
    void read(const std::string& key, std::uint32_t& target) const;
    void read(const std::string& key, bool& target) const;
    void read(const std::string& key, std::string& target) const;
    void read(const std::string& key, glm::dvec3& target, Range range) const;
    void read(const std::string& key, glm::vec3& target, Range range) const;
    void read(const std::string& key, glm::vec2& target, Range range) const;
    void read_color(const std::string& key, glm::vec3& target, double high) const;

private:
    YamlValue value_;
    std::string what_;
    std::vector<std::pair<std::string, YamlValue>> entries_;
};

/// Parse one document. Throws Error at the place of a syntax error.
YamlValue parse_yaml(const std::string& text, const std::string& file);

} // namespace postfx::host
