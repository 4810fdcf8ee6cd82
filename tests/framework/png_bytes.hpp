// PNG files by hand.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace postfx::testing {

inline std::string big_endian(std::uint32_t x) {
    return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
            static_cast<char>(x)};
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
    const std::string covered = type + data;
    const auto checksum =
        crc32(0, reinterpret_cast<const Bytef*>(covered.data()), static_cast<uInt>(covered.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + covered
           + big_endian(static_cast<std::uint32_t>(checksum));
}

/// As zlib stores it without compressing.
inline std::string stored_zlib(const std::string& data) {
    const auto length = static_cast<std::uint16_t>(data.size());
    const auto inverse = static_cast<std::uint16_t>(~length);
    std::string bytes = "\x78\x01\x01";
    for (const std::uint16_t x : {length, inverse})
        bytes += {static_cast<char>(x & 255), static_cast<char>(x >> 8)};
    const auto checksum =
        adler32(1, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
    return bytes + data + big_endian(static_cast<std::uint32_t>(checksum));
}

/// Uncompressed; `rows` from the top, each with its filter byte; `statements`: chunks before the pixels.
inline std::string stored_png(std::uint32_t width, std::uint32_t height, int bits, int color_type,
                              const std::string& rows, const std::string& statements = {}) {
    const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(bits)
                               + static_cast<char>(color_type) + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + statements + png_chunk("IDAT", stored_zlib(rows))
           + png_chunk("IEND", "");
}

} // namespace postfx::testing
