// YAML text as a small tree in which every node knows where it stands.
#pragma once

#include <postfx/error.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

struct YamlMember;

/// One value of the document. The limits of parse_yaml() bound its depth, so it may be walked recursively.
struct YamlNode {
    enum class Kind { nothing, scalar, list, map };

    Kind kind = Kind::nothing;
    Place place;                     ///< of its first character; of its key when it is an empty value
    std::string text;                ///< scalar: without quotes and escapes
    bool quoted = false;             ///< scalar in quotes or block style: text, whatever it looks like
    std::vector<YamlNode> items;     ///< list
    std::vector<YamlMember> members; ///< map, in the order of the file; keys are unique

    bool is(Kind other) const { return kind == other; }
    /// What a message says was found: "nothing", "a list", "a map" or the scalar in quotes.
    std::string found() const;
};

struct YamlMember {
    YamlNode key; ///< always a scalar
    YamlNode value;
};

/// Bounds that no chain written by a person comes near. They keep hostile files cheap: time and memory grow
/// with the text alone, and the parser's recursion stays shallow.
struct YamlLimits {
    static constexpr std::size_t bytes = std::size_t{1024} * 1024;
    static constexpr std::size_t depth = 16;
    static constexpr std::size_t nodes = 20'000; ///< keys and values
};

/// The one document in `text`; a node of Kind::nothing at 1:1 when there is none. Throws Error with the
/// position for text that is no UTF-8 or has control characters, is over the limits or not YAML, for a second
/// document, a repeated key, a key that is no word, and for anchors, aliases, merge keys and tags: a chain
/// needs none of them, `include` shares values, and without aliases a small file can't grow large in memory.
YamlNode parse_yaml(std::string_view text, const std::string& origin);

/// `; decimals are written with a point: 0.5` when two of the items look like one number with a comma; else "".
std::string decimal_comma_hint(const std::vector<YamlNode>& items);

/// `text` in double quotes, on one line and of bounded length, for messages.
std::string quote(std::string_view text);

} // namespace postfx
