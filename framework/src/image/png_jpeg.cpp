#include <image/formats.hpp>
#include <image/srgb.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace postfx::formats {
namespace {

std::size_t byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}

/// The size in a PNG's first chunk; stb_image calls a file with an absurd one no image at all.
void check_png_size(const Path& file, std::string_view bytes) {
    const auto number_at = [&](std::size_t at) {
        long long number = 0;
        for (std::size_t i = at; i < at + 4; ++i)
            number = number << 8 | static_cast<long long>(byte_at(bytes, i));
        return number;
    };
    if (bytes.size() >= 24) check_size(file, number_at(16), number_at(20));
}

/// Do the Huffman tables of a DHT segment (without its length) have at most 256 codes each? stb_image 2.27
/// writes past its arrays for more.
bool huffman_tables_good(std::string_view segment) {
    while (segment.size() >= 17) {
        std::size_t codes = 0;
        for (std::size_t i = 1; i <= 16; ++i)
            codes += byte_at(segment, i);
        if (codes > 256) return false;
        segment.remove_prefix(std::min(segment.size(), 17 + codes));
    }
    return segment.empty();
}

/// Throws Error for what stb_image gets wrong: it paints what a truncated file lacks grey and says nothing.
void check_jpeg_segments(const Path& file, std::string_view bytes) {
    for (std::size_t at = 2; at + 1 < bytes.size();) {
        // Between segments is entropy-coded data, in which 0xff stands before 0, a restart marker or a fill
        // byte only.
        const std::size_t marker = byte_at(bytes, at + 1);
        const bool in_data =
            byte_at(bytes, at) != 0xff || marker == 0 || marker == 0xff || (marker & ~7u) == 0xd0;
        if (in_data) {
            ++at;
            continue;
        }
        if (marker == 0xd9) return;
        if (at + 4 > bytes.size()) break;
        // The length counts itself. Skipping by it matters: a segment may hold a thumbnail with an end of its
        // own.
        const std::size_t length = byte_at(bytes, at + 2) << 8 | byte_at(bytes, at + 3);
        if (length < 2) fail(file, "damaged JPEG: a segment shorter than its own length");
        if (marker == 0xc4 && !huffman_tables_good(bytes.substr(at + 4, length - 2)))
            fail(file, "truncated or damaged JPEG: a Huffman table of the wrong size");
        at += 2 + length;
    }
    fail(file, "truncated JPEG: its end marker is missing");
}

enum class Meaning {
    light, ///< sRGB-decoded; alpha is not
    data,  ///< codes divided by the largest code
};

/// Scene value of every code.
std::vector<float> decoding_table(std::size_t codes, Meaning meaning) {
    std::vector<float> table(codes);
    for (std::size_t code = 0; code < codes; ++code) {
        const double value = static_cast<double>(code) / static_cast<double>(codes - 1);
        table[code] = static_cast<float>(meaning == Meaning::light ? srgb_to_linear(value) : value);
    }
    return table;
}

template<class Code>
Image decoded(const Code* codes, int width, int height, int channels, Meaning meaning) {
    constexpr std::size_t code_count = std::size_t{std::numeric_limits<Code>::max()} + 1;
    const std::vector<float> color = decoding_table(code_count, meaning);
    const std::vector<float> alpha = decoding_table(code_count, Meaning::data);
    const int color_channels = channels - (channels == 2 || channels == 4 ? 1 : 0);
    Image image(width, height, channels);
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < channels; ++channel)
                image.at(x, y, channel) = (channel < color_channels ? color : alpha)[*codes++];
    return image;
}

struct FreeCodes {
    void operator()(void* codes) const { stbi_image_free(codes); }
};

Coding coding_of(int channels, int bits) {
    const bool has_alpha = channels == 2 || channels == 4;
    return {.numbers = Coding::Numbers::codes,
            .bits = bits,
            .plain_srgb = true,
            .alpha = has_alpha ? Coding::Alpha::straight : Coding::Alpha::none};
}

bool recognises_png(std::string_view bytes) {
    return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

bool recognises_jpeg(std::string_view bytes) {
    return bytes.starts_with("\xff\xd8\xff");
}

ImageFile read_png_or_jpeg(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    const Path& file = source.name;
    const std::string_view bytes = source.bytes;
    const Meaning meaning = is_light(request.role) ? Meaning::light : Meaning::data;
    const char* kind = recognises_png(bytes) ? "PNG" : "JPEG";
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        fail(file, fmt::format("absurd size: a {} of {} bytes", kind, bytes.size()));
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    const auto check = [&](bool good) {
        if (!good) fail(file, fmt::format("truncated or damaged {} ({})", kind, stbi_failure_reason()));
    };
    if (recognises_png(bytes))
        check_png_size(file, bytes);
    else
        check_jpeg_segments(file, bytes);
    int width = 0, height = 0, channels = 0;
    check(stbi_info_from_memory(data, size, &width, &height, &channels) != 0);
    check_size(file, width, height);

    if (stbi_is_16_bit_from_memory(data, size)) {
        const std::unique_ptr<stbi_us, FreeCodes> codes(
            stbi_load_16_from_memory(data, size, &width, &height, &channels, 0));
        check(codes != nullptr);
        return {.image = decoded(codes.get(), width, height, channels, meaning),
                .coding = coding_of(channels, 16)};
    }
    const std::unique_ptr<stbi_uc, FreeCodes> codes(
        stbi_load_from_memory(data, size, &width, &height, &channels, 0));
    check(codes != nullptr);
    return {.image = decoded(codes.get(), width, height, channels, meaning),
            .coding = coding_of(channels, 8)};
}

ImageDescription describe_png_or_jpeg(const ImageSource& source) {
    const ImageFile file = read_png_or_jpeg(source, {.role = Role::data});
    return description_of_one(recognises_png(source.bytes) ? png.name : jpeg.name, file.image,
                              fmt::format("{} bit", file.coding.bits));
}

} // namespace

const Format png = {"PNG", recognises_png, read_png_or_jpeg, describe_png_or_jpeg};
const Format jpeg = {"JPEG", recognises_jpeg, read_png_or_jpeg, describe_png_or_jpeg};

std::string png_bytes(const Path& file, const BasicImage<std::uint8_t>& codes) {
    const BasicImage<std::uint8_t> rows = upside_down(codes);
    std::string bytes;
    const auto append = [](void* to, void* from, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(from), static_cast<std::size_t>(size));
    };
    if (!stbi_write_png_to_func(append, &bytes, rows.width, rows.height, rows.channels, rows.values.data(),
                                rows.width * rows.channels))
        fail(file, fmt::format("no PNG could be made of {} x {} pixels", rows.width, rows.height));
    return bytes;
}

} // namespace postfx::formats
