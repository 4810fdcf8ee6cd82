// The chunks of a PNG file (ISO/IEC 15948), for what they say of its pixels.
#pragma once

#include <image/color_statement.hpp>
#include <image/formats.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace postfx::formats {

struct PngChunk {
    std::string type{}; ///< "IHDR", ...
    std::string_view data{};
};

/// The head of the file, and every chunk that is whole.
struct PngChunks {
    std::uint32_t width = 0, height = 0;
    int bits = 0, color_type = 0;
    bool complete = false; ///< it has its end
    std::vector<PngChunk> chunks{};
    std::vector<std::string>
        warnings{}; ///< damaged chunks that are left out, although the pixels don't need them

    /// Nothing if there is none; the first of several.
    const std::string_view* find(std::string_view type) const;
};

/// Throws Error for a file without a head. `bytes` begin with the signature.
PngChunks png_chunks(const Path& file, std::string_view bytes);

/// cICP before iCCP before sRGB before gAMA and cHRM, as the third edition of the standard has it (4.3).
ColorStatement color_of(const PngChunks& png);

/// Inflated; nothing if there is none or it is damaged.
std::optional<std::string> icc_profile_of(const PngChunks& png);

/// A big-endian number of `size` bytes at `at`.
std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t size = 4);

} // namespace postfx::formats
