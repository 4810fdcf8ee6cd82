#include <postfx/format.hpp>

#include <array>

namespace postfx {
namespace {

constexpr std::array<FormatInfo, 11> formats = {{
    {Format::r8, "r8", 1, 1},
    {Format::rg8, "rg8", 2, 2},
    {Format::rgba8, "rgba8", 4, 4},
    {Format::r16f, "r16f", 1, 2},
    {Format::rg16f, "rg16f", 2, 4},
    {Format::rgba16f, "rgba16f", 4, 8},
    {Format::r32f, "r32f", 1, 4},
    {Format::rg32f, "rg32f", 2, 8},
    {Format::rgba32f, "rgba32f", 4, 16},
    {Format::r11g11b10f, "r11g11b10f", 3, 4},
    {Format::depth32f, "depth32f", 1, 4},
}};

} // namespace

const FormatInfo& format_info(Format format) {
    return formats[static_cast<std::size_t>(format)];
}

std::optional<Format> format_by_name(std::string_view name) {
    for (const FormatInfo& info : formats) {
        if (info.name == name) return info.format;
    }
    return std::nullopt;
}

} // namespace postfx
