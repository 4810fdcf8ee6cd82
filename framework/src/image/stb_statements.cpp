#include <image/stb_statements.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace postfx::formats {
namespace {

/// 0 for bytes that are not there: a statement that is cut off is none.
std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t size, std::endian order) {
    if (at > bytes.size() || size > bytes.size() - at) return 0;
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < size; ++i)
        result = result << 8
                 | static_cast<std::uint8_t>(bytes[at + (order == std::endian::little ? size - 1 - i : i)]);
    return result;
}

std::uint32_t little(std::string_view bytes, std::size_t at, std::size_t size = 4) {
    return number(bytes, at, size, std::endian::little);
}

std::uint32_t big(std::string_view bytes, std::size_t at, std::size_t size = 4) {
    return number(bytes, at, size, std::endian::big);
}

void take_profile(std::string_view profile, StoredPicture& picture) {
    picture.color = color_of_icc(profile, picture.color_channels());
    if (picture.color.profile) picture.attributes.emplace_back("ICC profile", picture.color.profile->name());
}

// ---- BMP: Windows' BITMAPINFOHEADER, BITMAPV4HEADER and BITMAPV5HEADER, behind 14 bytes

constexpr std::size_t bmp_header = 14;

/// Three points of CIEXYZ in 2.30 fixed point. Some writers put chromaticities there, whose sums are 1 and which say
/// nothing of the white.
std::optional<Chromaticities> bmp_primaries(std::string_view bytes) {
    constexpr std::size_t endpoints = bmp_header + 60;
    std::array<std::array<double, 3>, 3> points{};
    std::array<double, 3> sums{}, white{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            points[i][j] =
                std::ldexp(static_cast<std::int32_t>(little(bytes, endpoints + 12 * i + 4 * j)), -30);
            sums[i] += points[i][j];
            white[j] += points[i][j];
        }
    if (std::all_of(sums.begin(), sums.end(), [](double sum) { return sum == 0; })) return std::nullopt;
    const auto point = [&](std::size_t i) {
        return Chromaticity{points[i][0] / sums[i], points[i][1] / sums[i]};
    };
    constexpr double rounding = 1e-3;
    const bool chromaticities =
        std::all_of(sums.begin(), sums.end(), [](double sum) { return std::abs(sum - 1) < rounding; });
    const double sum = white[0] + white[1] + white[2];
    return Chromaticities{point(0), point(1), point(2),
                          chromaticities ? rec709_chromaticities.white
                                         : Chromaticity{white[0] / sum, white[1] / sum}};
}

/// The exponent from codes to light; writers that give its inverse are understood.
std::optional<double> bmp_gamma(std::string_view bytes, std::vector<std::string>& warnings) {
    std::array<double, 3> gammas{};
    for (std::size_t i = 0; i < 3; ++i)
        gammas[i] = std::ldexp(little(bytes, bmp_header + 96 + 4 * i), -16);
    if (!(gammas[0] > 0)) return std::nullopt;
    if (gammas[1] != gammas[0] || gammas[2] != gammas[0])
        warnings.push_back(fmt::format("BMP gammas {:.4g} {:.4g} {:.4g}: the first one was taken", gammas[0],
                                       gammas[1], gammas[2]));
    return gammas[0] < 1 ? 1 / gammas[0] : gammas[0];
}

void take_embedded_profile(std::string_view bytes, StoredPicture& picture) {
    const std::size_t at = bmp_header + little(bytes, bmp_header + 112),
                      size = little(bytes, bmp_header + 116);
    const bool there = at < bytes.size() && size <= bytes.size() - at;
    take_profile(there ? bytes.substr(at, size) : std::string_view(), picture);
}

void take_density(StoredPicture& picture, double across, double down) {
    if (across > 0 && down > 0 && across != down) picture.shot.pixel_aspect_ratio = down / across;
}

// ---- TGA: Truevision, version 2.0, "Extension Area"

constexpr std::size_t tga_footer = 26, tga_extension_size = 495;

/// Empty where the file has none.
std::string_view tga_extension(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.size() < tga_footer || !bytes.ends_with("TRUEVISION-XFILE.\0"sv)) return {};
    const std::size_t at = little(bytes, bytes.size() - tga_footer);
    return at == 0 || at > bytes.size() ? std::string_view() : bytes.substr(at, tga_extension_size);
}

void mirror(Image& image) {
    const Image stored = image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            std::copy_n(stored.pixel(image.width - 1 - x, y), image.channels, image.pixel(x, y));
}

void leave_out_alpha(StoredPicture& picture, const char* why) {
    const Image stored = std::move(picture.samples);
    picture.samples = Image(stored.width, stored.height, stored.channels - 1);
    for (std::size_t i = 0; i < stored.pixel_count(); ++i)
        std::copy_n(&stored.values[i * static_cast<std::size_t>(stored.channels)], picture.samples.channels,
                    &picture.samples.values[i * static_cast<std::size_t>(picture.samples.channels)]);
    picture.coding.alpha = Coding::Alpha::none;
    picture.warnings.push_back(fmt::format("TGA: {}: its alpha is left out", why));
}

bool is_without_cover(const Image& image) {
    for (std::size_t i = 1; i <= image.pixel_count(); ++i)
        if (image.values[i * static_cast<std::size_t>(image.channels) - 1] != 0) return false;
    return true;
}

void take_tga_alpha(std::string_view bytes, std::string_view extension, StoredPicture& picture) {
    if (picture.coding.alpha == Coding::Alpha::none) return;
    constexpr std::size_t descriptor = 17, alpha_kind = 494;
    constexpr std::uint32_t none = 0, to_ignore = 1, premultiplied = 4;
    if (extension.size() > alpha_kind) {
        const std::uint32_t kind = little(extension, alpha_kind, 1);
        if (kind == none || kind == to_ignore)
            leave_out_alpha(picture, "says that it has none");
        else if (kind == premultiplied)
            divide_codes_by_alpha(picture);
    } else if ((little(bytes, descriptor, 1) & 15) == 0 && is_without_cover(picture.samples)) {
        leave_out_alpha(picture, "counts no bits of alpha, and all of them are 0");
    }
}

void take_tga_gamma(std::string_view extension, ColorStatement& color) {
    const double above = little(extension, 478, 2), below = little(extension, 480, 2);
    // One decimal is all that the format asks for, and what shows pictures is sRGB rather than 2.2.
    constexpr double srgb_gamma = 2.2, rounding = 0.05;
    if (!(above > 0) || !(below > 0) || std::abs(above / below - srgb_gamma) <= rounding) return;
    color.to_light = [gamma = above / below](double code) { return std::pow(code, gamma); };
    color.honoured.push_back(fmt::format("TGA: codes are light to the power of 1/{:.4g}", above / below));
}

// ---- PSD: Adobe Photoshop File Formats Specification, "Image Resources Section"

constexpr std::size_t psd_header = 26;

/// Where the sections behind the header begin: a length of four bytes each, then so many bytes.
std::size_t psd_section(std::string_view bytes, int index) {
    std::size_t at = psd_header;
    for (int i = 0; i < index; ++i)
        at += 4 + big(bytes, at);
    return at;
}

/// The data of a resource; empty if there is none.
std::string_view psd_resource(std::string_view bytes, std::uint32_t wanted) {
    std::size_t at = psd_section(bytes, 1) + 4;
    const std::size_t end = std::min(bytes.size(), psd_section(bytes, 2));
    constexpr std::size_t before_name = 6;
    while (at + before_name < end && bytes.substr(at, 4) == "8BIM") {
        const std::size_t name = 1 + little(bytes, at + before_name, 1);
        const std::size_t length_at = at + before_name + name + name % 2;
        const std::size_t data = length_at + 4, size = big(bytes, length_at);
        if (data > end || size > end - data) return {};
        if (big(bytes, at + 4, 2) == wanted) return bytes.substr(data, size);
        at = data + size + size % 2;
    }
    return {};
}

} // namespace

void take_bmp_statements(std::string_view bytes, StoredPicture& picture) {
    constexpr std::uint32_t version_3 = 40, version_4 = 108, version_5 = 124;
    const std::uint32_t header = little(bytes, bmp_header);
    if (header >= version_3) take_density(picture, little(bytes, 38), little(bytes, 42));
    if (header < version_4) return;
    constexpr std::uint32_t calibrated = 0, embedded = 0x4d424544, linked = 0x4c494e4b;
    const std::uint32_t kind = little(bytes, bmp_header + 56);
    if (kind == calibrated)
        picture.color = color_of_colorimetry("BMP", bmp_gamma(bytes, picture.warnings), bmp_primaries(bytes));
    else if (kind == embedded && header >= version_5)
        take_embedded_profile(bytes, picture);
    else if (kind == linked)
        picture.color.warnings.emplace_back("BMP: its ICC profile is another file; taken as sRGB");
}

void take_tga_statements(std::string_view bytes, StoredPicture& picture) {
    constexpr std::size_t descriptor = 17;
    constexpr std::uint32_t from_right = 0x10;
    if (little(bytes, descriptor, 1) & from_right) mirror(picture.samples);
    const std::string_view extension = tga_extension(bytes);
    take_tga_alpha(bytes, extension, picture);
    take_tga_gamma(extension, picture.color);
    // Width over height, not densities.
    take_density(picture, little(extension, 476, 2), little(extension, 474, 2));
}

void take_psd_statements(std::string_view bytes, StoredPicture& picture) {
    constexpr std::uint32_t profile = 1039, exif = 1058, pixel_aspect = 1064;
    const std::string_view icc = psd_resource(bytes, profile);
    if (!icc.empty()) take_profile(icc, picture);
    if (const std::string_view data = psd_resource(bytes, exif); !data.empty())
        take_exif(picture, data, !icc.empty());
    if (const std::string_view data = psd_resource(bytes, pixel_aspect); data.size() >= 12) {
        const auto ratio =
            std::bit_cast<double>(std::uint64_t{big(data, 4)} << 32 | std::uint64_t{big(data, 8)});
        if (ratio > 0 && std::isfinite(ratio) && ratio != 1) picture.shot.pixel_aspect_ratio = ratio;
    }
}

int psd_bits(std::string_view bytes) {
    return bytes.starts_with("8BPS") && big(bytes, 22, 2) == 16 ? 16 : 8;
}

std::string problem_of(std::string_view bytes) {
    constexpr std::uint32_t bmp_runs_8 = 1, bmp_runs_4 = 2;
    const std::uint32_t compression = bytes.starts_with("BM") ? little(bytes, bmp_header + 16) : 0;
    if (compression == bmp_runs_8 || compression == bmp_runs_4)
        return "a BMP that is run-length coded (RLE); save it without, or as PNG";
    const bool packed = psd_bits(bytes) == 16 && big(bytes, psd_section(bytes, 3), 2) != 0;
    return packed ? "a PSD of 16 bits that is run-length coded (RLE); save it as TIFF or PNG" : "";
}

} // namespace postfx::formats
