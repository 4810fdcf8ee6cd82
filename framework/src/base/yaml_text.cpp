#include "base/yaml_text.hpp"

#include "base/yaml_mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace postfx {
namespace {

/// Length in bytes of the UTF-8 character that `text` starts with, 0 when there is none: cut short, overlong,
/// a surrogate or above U+10FFFF (RFC 3629).
std::size_t utf8_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || text.size() < length) return 0;
    if (!std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length),
                     continues_character)) {
        return 0;
    }
    const auto second = static_cast<unsigned char>(text[1]);
    const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
    const bool not_a_character = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);
    return overlong || not_a_character ? 0 : length;
}

} // namespace

bool continues_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

YamlText::YamlText(std::string_view text, std::string origin) : text_(text), origin_(std::move(origin)) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
}

Place YamlText::place_of(std::size_t offset) const {
    offset = std::min(offset, text_.size());
    if (offset < counted_.offset) counted_ = {};
    for (; counted_.offset < offset; ++counted_.offset) {
        if (text_[counted_.offset] == '\n') {
            ++counted_.line;
            counted_.column = 1;
        } else if (!continues_character(text_[counted_.offset])) {
            ++counted_.column;
        }
    }
    return {.file = origin_, .line = counted_.line, .column = counted_.column};
}

void YamlText::check_characters() const {
    for (std::size_t offset = 0; offset < text_.size();) {
        const auto byte = static_cast<unsigned char>(text_[offset]);
        if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F) {
            throw Error(place_of(offset),
                        fmt::format("expected plain text in UTF-8, found the byte 0x{:02X}", byte));
        }
        const std::size_t length = utf8_length(text_.substr(offset));
        if (length == 0) {
            throw Error(place_of(offset),
                        fmt::format("expected text in UTF-8, found the byte 0x{:02X} out of place", byte));
        }
        offset += length;
    }
}

void YamlText::check_quotes() const {
    if (const auto mistake = find_unclosed_quote(text_))
        throw Error(place_of(mistake->offset), "this is not YAML: " + mistake->message);
}

Error YamlText::syntax_error(std::size_t offset, const std::string& complaint) const {
    const auto mistake = find_yaml_mistake(text_, offset);
    if (!mistake) return {place_of(offset), "this is not YAML: " + complaint};
    return {place_of(mistake->offset), "this is not YAML: " + mistake->message};
}

} // namespace postfx
