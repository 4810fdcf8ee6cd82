// The usual mistakes of people who write YAML, found in text that a parser refused.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace postfx {

struct YamlMistake {
    std::size_t offset = 0; ///< of the character that is to blame
    std::string message;    ///< "the quote that opens here is never closed"
};

/// What explains that a parser gave up at byte `refused`; nullopt when it is none of the usual mistakes. Only a guess
/// about text that is wrong: legal YAML is not shown to it.
std::optional<YamlMistake> find_yaml_mistake(std::string_view text, std::size_t refused);

/// A quote that goes on to the end of the text, which yaml-cpp takes for closed there.
std::optional<YamlMistake> find_unclosed_quote(std::string_view text);

} // namespace postfx
