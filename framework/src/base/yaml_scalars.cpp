#include "base/yaml_scalars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace postfx {
namespace {

constexpr std::string_view digits = "0123456789";

bool is_all_of(std::string_view text, std::string_view characters) {
    return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), text) != words.end();
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return result;
}

/// 0x1F or 0o17, which have no sign.
std::optional<double> with_base(std::string_view text, int base) {
    std::uint64_t value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (failure == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return static_cast<double>(value);
}

/// [0-9]* ( . [0-9]* )? ( [eE] [-+]? [0-9]+ )?, with a digit before the exponent.
bool is_decimal(std::string_view text) {
    const std::size_t exponent = text.find_first_of("eE");
    std::string mantissa(text.substr(0, exponent));
    if (const std::size_t point = mantissa.find('.'); point != std::string::npos) mantissa.erase(point, 1);
    if (!is_all_of(mantissa, digits)) return false;
    if (exponent == std::string_view::npos) return true;
    std::string_view power = text.substr(exponent + 1);
    if (power.starts_with('-') || power.starts_with('+')) power.remove_prefix(1);
    return is_all_of(power, digits);
}

std::optional<double> decimal(std::string_view text) {
    if (!is_decimal(text)) return std::nullopt;
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc::result_out_of_range) return value;
    const bool tiny = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
    return tiny ? 0 : std::numeric_limits<double>::infinity();
}

std::string_view without_sign(std::string_view text) {
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    return text;
}

} // namespace

std::optional<bool> core_bool(std::string_view text) {
    if (is_one_of(text, {"true", "True", "TRUE"})) return true;
    if (is_one_of(text, {"false", "False", "FALSE"})) return false;
    return std::nullopt;
}

std::optional<double> core_number(std::string_view text) {
    if (text.starts_with("0x")) return with_base(text.substr(2), 16);
    if (text.starts_with("0o")) return with_base(text.substr(2), 8);
    if (is_one_of(text, {".nan", ".NaN", ".NAN"})) return std::numeric_limits<double>::quiet_NaN();
    const std::string_view magnitude = without_sign(text);
    const std::optional<double> value = is_one_of(magnitude, {".inf", ".Inf", ".INF"})
                                            ? std::numeric_limits<double>::infinity()
                                            : decimal(magnitude);
    return value && text.starts_with('-') ? -*value : value;
}

std::string bool_hint(std::string_view text) {
    const std::string word = lower(text);
    if (is_one_of(word, {"yes", "y", "on"})) return "; write true";
    if (is_one_of(word, {"no", "n", "off"})) return "; write false";
    // "tRUE": the words in other letters than the three spellings.
    return is_one_of(word, {"true", "false"}) ? "; write " + word : "";
}

std::string number_hint(std::string_view text) {
    const std::size_t comma = text.find(',');
    return comma == std::string_view::npos ? "" : comma_hint(text.substr(0, comma), text.substr(comma + 1));
}

std::string comma_hint(std::string_view before, std::string_view after) {
    if (!is_all_of(without_sign(before), digits) || !core_number(after)
        || !is_all_of(after.substr(0, 1), digits))
        return "";
    return fmt::format("; decimals are written with a point: {}.{}", before, after);
}

std::string colon_hint(std::string_view text, const std::vector<std::string>& keys) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    if (text.size() > 1 && text[0] == '-' && is_letter(text[1])) return "; a blank is missing behind \"-\"";
    const std::size_t end = text.find_first_of(" :={[");
    if (end == std::string_view::npos || end == 0) return "";
    const std::string_view key = text.substr(0, end);
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) return "";
    const std::string_view rest = text.substr(std::min(text.find_first_not_of(' ', end), text.size()));
    if (rest.starts_with(':')) return fmt::format("; a blank is missing behind \"{}:\"", key);
    if (rest.starts_with('=')) return fmt::format("; write \"{}: ...\", with a colon", key);
    return fmt::format("; a colon is missing behind \"{}\"", key);
}

} // namespace postfx
