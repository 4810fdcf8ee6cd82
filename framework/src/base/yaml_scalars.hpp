// Words and numbers as YAML 1.2's core schema has them (chapter 10.3.2), for every file that people write.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

/// true, True, TRUE, false, False, FALSE; nullopt for anything else.
std::optional<bool> core_bool(std::string_view text);

/// 12, -1.5, .5, 1e3, 0o17, 0x1F, .inf, .nan; nullopt for anything else. What is too large for a double is infinite, what
/// is too small 0.
std::optional<double> core_number(std::string_view text);

/// `; write true` for a word that other YAMLs take for a bool (yes, no, on, off, y, n); else "".
std::string bool_hint(std::string_view text);

/// `; decimals are written with a point: 0.5` for 0,5; else "".
std::string number_hint(std::string_view text);

/// The same when a list or map has other items than expected: whole numbers that stand around commas without a blank.
std::string comma_hint(std::string_view before, std::string_view after);

/// `; a colon is missing behind "glow"`, when `text` begins with one of the `keys`, and a value rather than a colon and
/// a blank follows it; the same of a list's dash; else "".
std::string colon_hint(std::string_view text, const std::vector<std::string>& keys);

} // namespace postfx
