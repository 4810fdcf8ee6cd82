// Segments of JPEG files, byte by byte, for tests.
#pragma once

#include <cstdint>
#include <string>

namespace postfx::testing {

inline std::string segment(int marker, const std::string& data) {
    const std::size_t length = data.size() + 2;
    return std::string{'\xff', static_cast<char>(marker), static_cast<char>(length >> 8),
                       static_cast<char>(length)}
           + data;
}

/// Segments behind the beginning.
inline std::string with_segments(std::string jpeg, const std::string& segments) {
    return jpeg.insert(2, segments);
}

inline std::string little(std::uint32_t value, int bytes = 4) {
    std::string text;
    for (int i = 0; i < bytes; ++i)
        text += static_cast<char>(value >> (8 * i));
    return text;
}

inline std::string field(int tag, int type, std::uint32_t count, std::uint32_t value) {
    return little(static_cast<std::uint32_t>(tag), 2) + little(static_cast<std::uint32_t>(type), 2)
           + little(count, 4) + little(value, 4);
}

/// Orientation, and behind it a directory with the focal length (4.25 mm), that for 35 mm film, and the colour space.
inline std::string exif_segment(int orientation, std::uint32_t color_space,
                                const std::string& interoperability = {}) {
    const std::uint32_t first = 8, second = first + 2 + 2 * 12 + 4, third = second + 2 + 4 * 12 + 4;
    std::string tiff = std::string("II*\0", 4) + little(first, 4);
    tiff += little(2, 2) + field(0x0112, 3, 1, static_cast<std::uint32_t>(orientation))
            + field(0x8769, 4, 1, second) + little(0, 4);
    tiff += little(4, 2) + field(0x920a, 5, 1, third) + field(0xa001, 3, 1, color_space)
            + field(0xa005, 4, 1, third + 8) + field(0xa405, 3, 1, 26) + little(0, 4);
    tiff += little(425, 4) + little(100, 4);
    tiff += little(1, 2) + little(1, 2) + little(2, 2) + little(4, 4)
            + (interoperability + std::string(4, '\0')).substr(0, 4) + little(0, 4);
    return segment(0xe1, std::string("Exif\0\0", 6) + tiff);
}

} // namespace postfx::testing
