#include <image/png_chunks.hpp>

#include <fmt/format.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::formats {
namespace {

constexpr std::size_t signature_size = 8, frame_size = 12; // length, type and checksum around a chunk's data

bool checksum_good(std::string_view chunk, std::size_t length) {
    const auto* covered = reinterpret_cast<const Bytef*>(chunk.data() + 4);
    return crc32(0, covered, static_cast<uInt>(length + 4)) == big_endian(chunk, 8 + length);
}

bool is_pixel_data(std::string_view type) {
    return type == "IHDR" || type == "PLTE" || type == "IDAT" || type == "IEND";
}

/// By inflating; nothing if it is damaged or unreasonably large (profiles of printers have some MiB).
std::optional<std::string> inflated(std::string_view deflated) {
    constexpr std::size_t largest = 1 << 25;
    std::string result;
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return std::nullopt;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(deflated.data()));
    stream.avail_in = static_cast<uInt>(deflated.size());
    std::array<char, 1 << 14> piece;
    int state = Z_OK;
    while (state == Z_OK && result.size() <= largest) {
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = piece.size();
        state = inflate(&stream, Z_NO_FLUSH);
        result.append(piece.data(), piece.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END) return std::nullopt;
    return result;
}

/// The third edition, 11.3.2.6: primaries, transfer, matrix (0), full range.
/// Nothing but a warning for code points that are not known.
std::optional<ColorStatement> color_of_cicp_chunk(std::string_view data, int bits,
                                                  std::vector<std::string>& warnings) {
    const auto byte = [&](std::size_t at) { return static_cast<int>(big_endian(data, at, 1)); };
    ColorStatement statement = color_of_cicp("PNG cICP", byte(0), byte(1), byte(3) != 0, bits);
    if (!statement.warnings.empty()) {
        warnings.insert(warnings.end(), statement.warnings.begin(), statement.warnings.end());
        return std::nullopt;
    }
    if (byte(2) != 0)
        statement.warnings.push_back(
            fmt::format("PNG cICP: matrix {} makes no sense for RGB; not followed", byte(2)));
    return statement;
}

/// Of the eight numbers of cHRM, in units of 1e-5, white first.
Chromaticities chromaticities_of(std::string_view data) {
    const auto point = [&](std::size_t at) {
        return Chromaticity{big_endian(data, at) / 1e5, big_endian(data, at + 4) / 1e5};
    };
    return {point(8), point(16), point(24), point(0)};
}

void take_gamma(std::string_view data, ColorStatement& statement) {
    const double gamma = big_endian(data, 0) / 1e5;
    if (!(gamma > 0)) {
        statement.warnings.emplace_back("PNG gAMA is 0, which means nothing; not followed");
        return;
    }
    // Writers of sRGB state 0.45455 for decoders that know no sRGB, and round it to 0.45 at worst: 1.01 %.
    constexpr double srgb_gamma = 1 / 2.2, rounding = 0.011;
    if (std::abs(gamma / srgb_gamma - 1) <= rounding) return;
    statement.honoured.push_back(gamma == 1
                                     ? std::string("PNG gAMA: linear")
                                     : fmt::format("PNG gAMA: codes are light to the power of {}", gamma));
    statement.to_light = [exponent = 1 / gamma](double code) { return std::pow(code, exponent); };
}

void take_chromaticities(std::string_view data, ColorStatement& statement) {
    const Chromaticities space = chromaticities_of(data);
    // Tools round to three digits.
    constexpr double rounding = 1.1e-3;
    const auto near = [](const Chromaticity& a, const Chromaticity& b) {
        return std::abs(a.x - b.x) <= rounding && std::abs(a.y - b.y) <= rounding;
    };
    const Chromaticities& own = rec709_chromaticities;
    if (near(space.red, own.red) && near(space.green, own.green) && near(space.blue, own.blue)
        && near(space.white, own.white))
        return;
    statement.to_rec709 = matrix_to_rec709(space, Adaptation::bradford);
    if (statement.to_rec709)
        statement.honoured.push_back(
            fmt::format("PNG cHRM: red {} {}, green {} {}, blue {} {}, white {} {} (which becomes ours)",
                        space.red.x, space.red.y, space.green.x, space.green.y, space.blue.x, space.blue.y,
                        space.white.x, space.white.y));
    else
        statement.warnings.emplace_back("PNG cHRM makes no colour space; not followed");
}

/// A chunk of at least `size` bytes.
const std::string_view* whole_chunk(const PngChunks& png, std::string_view type, std::size_t size,
                                    ColorStatement& statement) {
    const std::string_view* data = png.find(type);
    if (!data || data->size() >= size) return data;
    statement.warnings.push_back(fmt::format("PNG {} is too short; not followed", type));
    return nullptr;
}

ColorStatement said_color(const PngChunks& png, ColorStatement statement) {
    if (const auto* cicp = whole_chunk(png, "cICP", 4, statement))
        if (auto by_code = color_of_cicp_chunk(*cicp, png.bits, statement.warnings))
            return *std::move(by_code);
    if (png.find("iCCP")) {
        const bool grey = (png.color_type & 2) == 0;
        const ColorStatement by_profile = color_of_icc(icc_profile_of(png).value_or(""), grey ? 1 : 3);
        if (by_profile.warnings.empty()) return by_profile;
        statement.warnings.insert(statement.warnings.end(), by_profile.warnings.begin(),
                                  by_profile.warnings.end());
    }
    if (png.find("sRGB")) return statement;
    if (const auto* gamma = whole_chunk(png, "gAMA", 4, statement)) take_gamma(*gamma, statement);
    if (const auto* space = whole_chunk(png, "cHRM", 32, statement); space && (png.color_type & 2) != 0)
        take_chromaticities(*space, statement);
    return statement;
}

} // namespace

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint32_t number = 0;
    for (std::size_t i = at; i < at + size; ++i)
        number = number << 8 | static_cast<std::uint8_t>(bytes.at(i));
    return number;
}

const std::string_view* PngChunks::find(std::string_view type) const {
    const auto found =
        std::find_if(chunks.begin(), chunks.end(), [&](const PngChunk& chunk) { return chunk.type == type; });
    return found == chunks.end() ? nullptr : &found->data;
}

PngChunks png_chunks(const Path& file, std::string_view bytes) {
    PngChunks png;
    bytes.remove_prefix(signature_size);
    while (bytes.size() >= frame_size && !png.complete) {
        const std::size_t length = big_endian(bytes, 0);
        if (length > bytes.size() - frame_size) break;
        PngChunk chunk{std::string(bytes.substr(4, 4)), bytes.substr(8, length)};
        png.complete = chunk.type == "IEND";
        if (is_pixel_data(chunk.type) || checksum_good(bytes, length))
            png.chunks.push_back(std::move(chunk));
        else if (std::all_of(chunk.type.begin(), chunk.type.end(),
                             [](unsigned char c) { return std::isalpha(c); }))
            png.warnings.push_back(fmt::format("its {} chunk is damaged and was left out", chunk.type));
        bytes.remove_prefix(length + frame_size);
    }
    const std::string_view* head = png.find("IHDR");
    if (!head || head != &png.chunks.front().data || head->size() != 13)
        fail(file, "truncated or damaged PNG: it has no head");
    png.width = big_endian(*head, 0);
    png.height = big_endian(*head, 4);
    png.bits = static_cast<int>(big_endian(*head, 8, 1));
    png.color_type = static_cast<int>(big_endian(*head, 9, 1));
    return png;
}

ColorStatement color_of(const PngChunks& png) {
    // A palette's entries have 8 bits, whatever its indices have; fewer bits of grey are stretched to 8.
    PngChunks stretched = png;
    stretched.bits = png.bits == 16 ? 16 : 8;
    return said_color(stretched, {});
}

std::optional<std::string> icc_profile_of(const PngChunks& png) {
    const std::string_view* data = png.find("iCCP");
    if (!data) return std::nullopt;
    // A name, its end, and the method, of which there is one (0: deflate).
    const std::size_t end = data->find('\0');
    if (end == std::string_view::npos || end + 2 > data->size()) return std::nullopt;
    return inflated(data->substr(end + 2));
}

} // namespace postfx::formats
