// TIFF, by libtiff: integers and floats, grey, RGB, CMYK and palettes, tiles and strips. What else a TIFF may hold
// (YCbCr, Lab, 1 bit) goes through libtiff's own conversion to 8-bit RGB, or is refused by it.
#include <image/formats.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

namespace postfx::formats {
namespace {

/// A file in memory, and what libtiff says of it.
struct Input {
    std::string_view bytes;
    std::size_t at = 0;
    std::string message{};
};

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t size) {
    auto& input = *static_cast<Input*>(handle);
    const std::size_t left = input.bytes.size() - std::min(input.at, input.bytes.size());
    const std::size_t count = std::min(static_cast<std::size_t>(std::max<tmsize_t>(size, 0)), left);
    if (count > 0) std::memcpy(to, input.bytes.data() + input.at, count);
    input.at += count;
    return static_cast<tmsize_t>(count);
}

toff_t seek(thandle_t handle, toff_t offset, int whence) {
    auto& input = *static_cast<Input*>(handle);
    const std::size_t base = whence == SEEK_CUR ? input.at : whence == SEEK_END ? input.bytes.size() : 0;
    input.at = base + static_cast<std::size_t>(offset);
    return input.at;
}

/// Of this file only: the first error is the cause.
int note_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
    std::array<char, 256> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    auto& message = static_cast<Input*>(user)->message;
    if (message.empty()) message = text.data();
    return 1;
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

struct CloseTiff {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

Tiff opened(Input& input) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, tmsize_t{1} << 32);
    TIFFOpenOptionsSetErrorHandlerExtR(options, note_error, &input);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, nullptr);
    Tiff tiff(TIFFClientOpenExt(
        "", "rm", &input, read_bytes, [](thandle_t, void*, tmsize_t) -> tmsize_t { return 0; }, seek,
        [](thandle_t) { return 0; },
        [](thandle_t handle) { return toff_t{static_cast<Input*>(handle)->bytes.size()}; }, nullptr, nullptr,
        options));
    TIFFOpenOptionsFree(options);
    return tiff;
}

template<class Number>
Number field(TIFF* tiff, ttag_t tag, Number otherwise) {
    Number value{};
    return TIFFGetFieldDefaulted(tiff, tag, &value) ? value : otherwise;
}

/// How the samples of a picture are laid out.
struct Layout {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 1, channels = 1, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK;
    bool planar = false, tiled = false;
    std::uint32_t block_width = 0, block_height = 0; ///< of a tile or a strip

    bool is_lab() const {
        return photometric == PHOTOMETRIC_CIELAB || photometric == PHOTOMETRIC_ICCLAB
               || photometric == PHOTOMETRIC_ITULAB;
    }
    bool is_float() const { return format == SAMPLEFORMAT_IEEEFP; }
    std::size_t sample_bytes() const { return bits / 8u; }
    /// Channels that lie together.
    int together() const { return planar ? 1 : channels; }
    /// Read sample by sample; the rest is left to libtiff's conversion.
    bool is_plain() const {
        const bool colors = photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE
                            || photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_SEPARATED;
        const bool integers = format == SAMPLEFORMAT_UINT && (bits == 8 || bits == 16 || bits == 32);
        return colors && (integers || (is_float() && (bits == 16 || bits == 32 || bits == 64)));
    }
};

/// 1 to 8, as EXIF has them.
std::uint16_t orientation_of(TIFF* tiff) {
    const auto orientation = field<std::uint16_t>(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    return orientation >= 1 && orientation <= 8 ? orientation : std::uint16_t{ORIENTATION_TOPLEFT};
}

Layout layout_of(const Path& file, TIFF* tiff) {
    Layout layout;
    layout.width = field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
    layout.height = field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
    check_size(file, layout.width, layout.height);
    layout.bits = field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
    layout.channels = field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    layout.format = field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    layout.photometric = field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    layout.planar =
        field<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
    layout.tiled = TIFFIsTiled(tiff) != 0;
    if (layout.format != SAMPLEFORMAT_UINT && layout.format != SAMPLEFORMAT_VOID && !layout.is_float())
        fail(file, "a TIFF of signed or complex numbers, expected unsigned ones or floats");
    if (layout.channels > 32)
        fail(file, fmt::format("a TIFF of {} channels, expected at most 32", layout.channels));
    if (layout.tiled) {
        layout.block_width = field<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0);
        layout.block_height = field<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0);
        check_size(file, layout.block_width, layout.block_height);
    } else {
        layout.block_width = layout.width;
        layout.block_height =
            std::min(layout.height, field<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, layout.height));
    }
    return layout;
}

float half_to_float(std::uint16_t half) {
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const float sign = half & 0x8000 ? -1.0f : 1.0f;
    if (exponent == 31) return mantissa ? std::nanf("") : sign * INFINITY;
    return sign
           * (exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                            : std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25));
}

template<class Number>
Number number_at(const std::uint8_t* bytes) {
    Number number;
    std::memcpy(&number, bytes, sizeof number);
    return number;
}

/// libtiff has brought the bytes into this machine's order.
float sample_at(const Layout& layout, const std::uint8_t* bytes) {
    if (layout.is_float())
        return layout.bits == 16   ? half_to_float(number_at<std::uint16_t>(bytes))
               : layout.bits == 32 ? number_at<float>(bytes)
                                   : static_cast<float>(number_at<double>(bytes));
    return layout.bits == 8    ? static_cast<float>(*bytes)
           : layout.bits == 16 ? static_cast<float>(number_at<std::uint16_t>(bytes))
                               : static_cast<float>(number_at<std::uint32_t>(bytes));
}

/// Which channels of the file are kept: its colours, and the first alpha.
struct Channels {
    int colors = 1;
    int alpha = -1; ///< which one, or -1
    bool premultiplied = false, others = false;
};

Channels channels_of(TIFF* tiff, const Layout& layout) {
    Channels channels;
    channels.colors = layout.photometric == PHOTOMETRIC_RGB         ? 3
                      : layout.photometric == PHOTOMETRIC_SEPARATED ? 4
                                                                    : 1;
    std::uint16_t count = 0;
    const std::uint16_t* kinds = nullptr;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds);
    for (int i = 0; i < count; ++i) {
        const bool alpha = kinds[i] == EXTRASAMPLE_ASSOCALPHA || kinds[i] == EXTRASAMPLE_UNASSALPHA;
        if (alpha && channels.alpha < 0 && channels.colors < 4) {
            channels.alpha = channels.colors + i;
            channels.premultiplied = kinds[i] == EXTRASAMPLE_ASSOCALPHA;
        } else {
            channels.others = true;
        }
    }
    channels.others = channels.others || layout.channels > channels.colors + count;
    return channels;
}

/// Copy what a block holds of the picture; `first`: its first channel in the file.
void copy_block(const Layout& layout, const std::vector<std::uint8_t>& block, std::uint32_t left,
                std::uint32_t top, int first, const Channels& channels, Image& samples) {
    const std::uint32_t right = std::min(layout.width, left + layout.block_width);
    const std::uint32_t bottom = std::min(layout.height, top + layout.block_height);
    const std::size_t pixel_bytes = layout.sample_bytes() * static_cast<std::size_t>(layout.together());
    for (std::uint32_t y = top; y < bottom; ++y)
        for (std::uint32_t x = left; x < right; ++x) {
            const std::size_t pixel = (std::size_t{y - top} * layout.block_width + (x - left)) * pixel_bytes;
            float* to = samples.pixel(static_cast<int>(x), static_cast<int>(layout.height - 1 - y));
            for (int i = 0; i < layout.together(); ++i) {
                const int channel = first + i;
                const int target = channel < channels.colors   ? channel
                                   : channel == channels.alpha ? channels.colors
                                                               : -1;
                if (target >= 0)
                    to[target] = sample_at(
                        layout, &block[pixel + static_cast<std::size_t>(i) * layout.sample_bytes()]);
            }
        }
}

/// Before anything of its size is allocated: what no compression of these makes of so few bytes (LZW, the best of them,
/// makes 4096 bytes of one code).
void check_plausible(const Path& file, TIFF* tiff, const Input& input, const Layout& layout) {
    constexpr double best_compression = 4096;
    const auto compression = field<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    const double ratio = compression == COMPRESSION_NONE ? 1
                         : compression == COMPRESSION_LZW || compression == COMPRESSION_PACKBITS
                                 || compression == COMPRESSION_ADOBE_DEFLATE
                                 || compression == COMPRESSION_DEFLATE
                             ? best_compression
                             : 1e9;
    const double bytes =
        double(layout.width) * layout.height * layout.channels * static_cast<double>(layout.sample_bytes());
    const double block = double(layout.block_width) * layout.block_height * layout.together()
                         * static_cast<double>(layout.sample_bytes());
    constexpr double largest_block = 1ULL << 32;
    if (bytes > ratio * static_cast<double>(input.bytes.size()) || block > largest_block)
        fail(file, fmt::format("truncated or damaged TIFF: {} bytes can't hold {} x {} pixels",
                               input.bytes.size(), layout.width, layout.height));
}

void read_blocks(const Path& file, TIFF* tiff, const Input& input, const Layout& layout,
                 const Channels& channels, Image& samples) {
    const tmsize_t size = layout.tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
    const std::size_t needed = std::size_t{layout.block_width} * layout.block_height * layout.sample_bytes()
                               * static_cast<std::size_t>(layout.together());
    if (size <= 0 || static_cast<std::size_t>(size) < needed)
        fail(file, "damaged TIFF: blocks of the wrong size");
    std::vector<std::uint8_t> block(static_cast<std::size_t>(size));
    const std::uint32_t across = (layout.width + layout.block_width - 1) / layout.block_width;
    const std::uint32_t down = (layout.height + layout.block_height - 1) / layout.block_height;
    const int planes = layout.planar ? layout.channels : 1;
    std::uint32_t number = 0;
    for (int plane = 0; plane < planes; ++plane)
        for (std::uint32_t row = 0; row < down; ++row)
            for (std::uint32_t column = 0; column < across; ++column, ++number) {
                const std::uint32_t rows =
                    std::min(layout.block_height, layout.height - row * layout.block_height);
                const tmsize_t wanted = layout.tiled ? size : TIFFVStripSize(tiff, rows);
                const tmsize_t got = layout.tiled ? TIFFReadEncodedTile(tiff, number, block.data(), size)
                                                  : TIFFReadEncodedStrip(tiff, number, block.data(), wanted);
                if (got < wanted)
                    fail(file, fmt::format("truncated or damaged TIFF ({})",
                                           input.message.empty() ? "a block is too short" : input.message));
                copy_block(layout, block, column * layout.block_width, row * layout.block_height, plane,
                           channels, samples);
            }
}

void read_plain(const Path& file, TIFF* tiff, const Input& input, const Layout& layout,
                StoredPicture& picture) {
    const Channels channels = channels_of(tiff, layout);
    check_plausible(file, tiff, input, layout);
    if (channels.colors > layout.channels)
        fail(file, "damaged TIFF: it has too few channels for its colours");
    picture.samples = Image(static_cast<int>(layout.width), static_cast<int>(layout.height),
                            channels.colors + (channels.alpha >= 0 ? 1 : 0));
    read_blocks(file, tiff, input, layout, channels, picture.samples);
    picture.cmyk = layout.photometric == PHOTOMETRIC_SEPARATED;
    picture.coding.bits = layout.bits;
    picture.largest = layout.is_float() ? 1 : std::ldexp(1.0, layout.bits) - 1;
    if (layout.is_float())
        picture.coding.numbers = layout.bits == 16 ? Coding::Numbers::half : Coding::Numbers::single;
    if (layout.photometric == PHOTOMETRIC_MINISWHITE)
        for (std::size_t i = 0; i < picture.samples.values.size();
             i += static_cast<std::size_t>(picture.samples.channels))
            picture.samples.values[i] = static_cast<float>(picture.largest - picture.samples.values[i]);
    if (channels.others) picture.warnings.emplace_back("it has further channels, which are left out");
    if (channels.alpha < 0) return;
    picture.coding.alpha = channels.premultiplied ? Coding::Alpha::premultiplied : Coding::Alpha::straight;
    if (!channels.premultiplied || layout.is_float()) return;
    divide_codes_by_alpha(picture);
}

/// By libtiff: 8-bit RGBA, alpha premultiplied.
void read_converted(const Path& file, TIFF* tiff, const Input& input, const Layout& layout,
                    StoredPicture& picture) {
    std::array<char, 1024> reason{};
    if (!TIFFRGBAImageOK(tiff, reason.data()))
        fail(file, fmt::format("a TIFF of no known kind ({})", reason.data()));
    std::vector<std::uint32_t> codes(std::size_t{layout.width} * layout.height);
    // Asked for the file's own orientation it mirrors nothing: it would leave out what exchanges the sides.
    if (!TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, codes.data(), orientation_of(tiff), 1))
        fail(file, fmt::format("truncated or damaged TIFF ({})", input.message));
    picture.samples = Image(static_cast<int>(layout.width), static_cast<int>(layout.height), 3);
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const auto x = static_cast<int>(i % layout.width), y = static_cast<int>(i / layout.width);
        float* to = picture.samples.pixel(x, picture.samples.height - 1 - y);
        to[0] = static_cast<float>(TIFFGetR(codes[i]));
        to[1] = static_cast<float>(TIFFGetG(codes[i]));
        to[2] = static_cast<float>(TIFFGetB(codes[i]));
    }
    if (layout.is_lab()) picture.warnings.emplace_back("its CIELAB colours were brought to sRGB of 8 bits");
    if (layout.bits > 8)
        picture.warnings.push_back(fmt::format("its {} bits were brought to 8", layout.bits));
}

/// Without an ICC profile: TIFF 6.0, section 20, "RGB Image Colorimetry".
ColorStatement colorimetry_of(TIFF* tiff) {
    const float *white = nullptr, *primaries = nullptr;
    std::optional<Chromaticities> space;
    if (TIFFGetField(tiff, TIFFTAG_PRIMARYCHROMATICITIES, &primaries)) {
        space = rec709_chromaticities;
        space->red = {primaries[0], primaries[1]};
        space->green = {primaries[2], primaries[3]};
        space->blue = {primaries[4], primaries[5]};
        if (TIFFGetField(tiff, TIFFTAG_WHITEPOINT, &white)) space->white = {white[0], white[1]};
    }
    ColorStatement color = color_of_colorimetry("TIFF", std::nullopt, space);
    const std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
    if (TIFFGetField(tiff, TIFFTAG_TRANSFERFUNCTION, &red, &green, &blue))
        color.warnings.emplace_back("its TransferFunction is not followed; taken as sRGB's");
    return color;
}

void take_statements(TIFF* tiff, const Layout& layout, StoredPicture& picture) {
    std::uint32_t size = 0;
    const char* profile = nullptr;
    if (TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &size, &profile)) {
        // Lab is no device's, so no profile is for it; libtiff has converted it.
        if (!layout.is_lab()) picture.color = color_of_icc({profile, size}, picture.color_channels());
    } else {
        picture.color = colorimetry_of(tiff);
    }
    if (picture.color.profile) picture.attributes.emplace_back("ICC profile", picture.color.profile->name());
    picture.orientation = orientation_of(tiff);
    float across = 0, down = 0;
    if (TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &across) && TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &down)
        && across > 0 && down > 0 && across != down)
        picture.shot.pixel_aspect_ratio = double{down} / across;
    if (TIFFNumberOfDirectories(tiff) > 1)
        picture.warnings.emplace_back("it has several pages: the first one was taken");
}

StoredPicture stored_tiff(const ImageSource& source) {
    Input input{.bytes = source.bytes};
    const Tiff tiff = opened(input);
    if (!tiff) fail(source.name, fmt::format("truncated or damaged TIFF ({})", input.message));
    const Layout layout = layout_of(source.name, tiff.get());
    StoredPicture picture;
    if (layout.is_plain())
        read_plain(source.name, tiff.get(), input, layout, picture);
    else
        read_converted(source.name, tiff.get(), input, layout, picture);
    take_statements(tiff.get(), layout, picture);
    return picture;
}

bool recognises_tiff(std::string_view bytes) {
    using namespace std::string_view_literals;
    return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) || bytes.starts_with("II+\0"sv)
           || bytes.starts_with("MM\0+"sv);
}

ImageFile read_tiff(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return as_asked(stored_tiff(source), request);
}

ImageDescription describe_tiff(const ImageSource& source) {
    return described(tiff.name, stored_tiff(source));
}

} // namespace

const Format tiff = {"TIFF", recognises_tiff, read_tiff, describe_tiff};

} // namespace postfx::formats
