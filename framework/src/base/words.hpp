// Enums and their words: as plugins, chain files and JSON have them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace postfx {

/// The words of an enum's values, in their order.
template<std::size_t count>
using Words = std::array<std::string_view, count>;

template<class Enum, std::size_t count>
std::string_view word_among(const Words<count>& words, Enum value) {
    return words.at(static_cast<std::size_t>(value));
}

/// Nothing when there is no such word.
template<class Enum, std::size_t count>
std::optional<Enum> value_among(const Words<count>& words, std::string_view word) {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) return std::nullopt;
    return static_cast<Enum>(found - words.begin());
}

} // namespace postfx
