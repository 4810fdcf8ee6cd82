// One reader and one writer per file format, on bytes in memory. files.cpp and write.cpp choose among them;
// nobody else includes this.
#pragma once

#include <image/files.hpp>

#include <postfx/error.hpp>
#include <postfx/image.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
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

/// Throws Error if so few bytes can't be a picture of so many pixels: a small file must not ask for all memory. What an
/// 8K display shows is always allowed; beyond that, no coding packs more than 2^15 equal pixels into a byte.
void check_plausible(const ImageSource& source, long long pixels);

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

/// A kind of image file. files.cpp has the list; a reader is given the whole file and what is asked of it.
struct Format {
    const char* name;                           ///< "PNG", "OpenEXR", ...: for messages
    bool (*recognises)(std::string_view bytes); ///< by the first bytes
    ImageFile (*read)(const ImageSource& source, const ImageRequest& request);
    ImageDescription (*describe)(const ImageSource& source);
};

/// Throws Error if a layer or a view is asked of a file that has none.
void expect_no_layers(const ImageSource& source, const ImageRequest& request);
/// Of a file with one picture, which serves every role; `type` is that of its channels.
ImageDescription description_of_one(const char* kind, const Image& image, const std::string& type);

extern const Format png, jpeg, heic, tiff, webp, exr, hdr, pfm, pnm;
/// Those that only stb_image reads; last, as one of them (TGA) has no signature.
extern const Format stb;

// ---- PNG and JPEG, sRGB

/// `codes`: 1 to 4 channels of 8 or 16 bits.
std::string png_bytes(const Path& file, const BasicImage<std::uint8_t>& codes);
std::string png_bytes(const Path& file, const BasicImage<std::uint16_t>& codes);

/// `codes`: 1 or 3 channels; `quality`: 0 to 1.
std::string jpeg_bytes(const Path& file, const BasicImage<std::uint8_t>& codes, double quality);

// ---- Radiance HDR

/// Three channels with one exponent: 8 bits of mantissa for the largest, nothing negative. NaN becomes 0,
/// values too large for the format its largest.
std::string hdr_bytes(const Image& rgb);

// ---- PFM: 1 or 3 channels, either byte order, bits kept. The magnitude of the scale, which most writers leave at 1
// and most readers ignore, is told of and ignored.

/// `image`: 1 or 3 channels. Little endian.
std::string pfm_bytes(const Image& image);

// ---- OpenEXR

/// Channels Y, YA, RGB or RGBA; half or float.
std::string exr_bytes(const Path& file, const Image& image, bool half);

/// The origin, an EXR, with `image` (3 or 4 channels, Rec. 709) where its picture was; see WriteOptions. Adds to `remarks`
/// what could not be kept.
std::string exr_bytes_carrying(const Path& file, const Image& image, const Origin& origin,
                               std::vector<std::string>& remarks);

} // namespace postfx::formats
