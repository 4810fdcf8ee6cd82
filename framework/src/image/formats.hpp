// One reader and one writer per file format, on bytes in memory. files.cpp and write.cpp choose among them;
// nobody else includes this.
#pragma once

#include <postfx/error.hpp>
#include <postfx/image.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace postfx::formats {

using Path = std::filesystem::path;

/// Larger pictures are taken for damaged or hostile files: 32768 pixels a side, 2^28 pixels (1 GiB per float
/// channel).
constexpr long long max_side = 1 << 15;
constexpr long long max_pixels = 1LL << 28;

[[noreturn]] void fail(const Path& file, const std::string& message);

/// Throws Error unless 1 <= width, height <= max_side and there are at most max_pixels.
void check_size(const Path& file, long long width, long long height);

/// The file's rows the other way up. Every format but PFM counts them from the top.
template<class Number>
BasicImage<Number> upside_down(const BasicImage<Number>& image) {
    BasicImage<Number> turned = image;
    const std::size_t row = static_cast<std::size_t>(image.width) * image.channels;
    for (int y = 0; y < image.height; ++y) {
        const auto from = image.values.begin() + static_cast<std::ptrdiff_t>(row * y);
        std::copy_n(from, row,
                    turned.values.begin() + static_cast<std::ptrdiff_t>(row * (image.height - 1 - y)));
    }
    return turned;
}

// ---- PNG and JPEG

enum class Meaning {
    light, ///< sRGB-decoded; alpha is not
    data,  ///< codes divided by the largest code
};
struct CodedImage {
    Image image;
    bool was_8bit = false;
};
bool is_png(std::string_view bytes);
bool is_jpeg(std::string_view bytes);
CodedImage read_png_or_jpeg(const Path& file, std::string_view bytes, Meaning meaning);
/// `codes`: 1 to 4 channels of 8 bits.
std::string png_bytes(const Path& file, const BasicImage<std::uint8_t>& codes);

// ---- Radiance HDR

bool is_hdr(std::string_view bytes);
Image read_hdr(const Path& file, std::string_view bytes);
/// Three channels with one exponent: 8 bits of mantissa for the largest, nothing negative. NaN becomes 0,
/// values too large for the format its largest.
std::string hdr_bytes(const Image& rgb);

// ---- PFM

bool is_pfm(std::string_view bytes);
/// 1 or 3 channels, either byte order, bits kept. The magnitude of the scale, which most writers leave at 1
/// and most readers ignore, is ignored.
Image read_pfm(const Path& file, std::string_view bytes);
/// `image`: 1 or 3 channels. Little endian.
std::string pfm_bytes(const Image& image);

// ---- OpenEXR

bool is_exr(std::string_view bytes);
struct ExrLayers {
    Image image;
    std::map<std::string, Image> layers;
};
/// The colour, and every further layer.
ExrLayers read_exr(const Path& file, const std::string& bytes);
/// One layer or channel; "" = depth if the file has one, else the colour.
Image read_exr_layer(const Path& file, const std::string& bytes, const std::string& layer);
/// Channels Y, YA, RGB or RGBA; half or float.
std::string exr_bytes(const Path& file, const Image& image, bool half);

} // namespace postfx::formats
