// Pixel formats of render targets. One table; names are the words that plugins and reports use.
#pragma once

#include <optional>
#include <string_view>

namespace postfx {

enum class Format { r8, rg8, rgba8, r16f, rg16f, rgba16f, r32f, rg32f, rgba32f, r11g11b10f, depth32f };

struct FormatInfo {
    Format format;
    std::string_view name; ///< "rgba16f"
    int channels;
    int bytes_per_pixel;
};

const FormatInfo& format_info(Format format);
/// The format of that name; nothing for an unknown word.
std::optional<Format> format_by_name(std::string_view name);

} // namespace postfx
