#include <image/formats.hpp>

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace postfx::formats {
namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// The words of the header; a longer one than any number needs is a damaged file.
class HeaderWords {
public:
    HeaderWords(const Path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    template<class Number>
    Number next(const char* what) {
        std::string_view word = next_word();
        if (word.starts_with('+')) word.remove_prefix(1); // which from_chars does not know
        Number number{};
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (problem != std::errc() || end != word.data() + word.size())
            fail(file_, fmt::format("damaged PFM header: the {} is not a number", what));
        return number;
    }
    /// Just behind the last word and the one white space that ends the header.
    std::size_t end() const { return at_ + 1; }

private:
    std::string_view next_word() {
        while (at_ < bytes_.size() && is_space(bytes_[at_]))
            ++at_;
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && !is_space(bytes_[at_]))
            ++at_;
        return bytes_.substr(begin, at_ - begin);
    }

    const Path& file_;
    std::string_view bytes_;
    std::size_t at_ = 2; ///< behind "PF"
};

std::uint32_t byte_swapped(std::uint32_t x) {
    return x << 24 | (x & 0xff00u) << 8 | (x >> 8 & 0xff00u) | x >> 24;
}

/// Between floats of this machine and bytes of the other order, or the other way.
void swap_bytes(char* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t word;
        std::memcpy(&word, bytes + i * sizeof word, sizeof word);
        word = byte_swapped(word);
        std::memcpy(bytes + i * sizeof word, &word, sizeof word);
    }
}

constexpr bool little_endian_machine = std::endian::native == std::endian::little;

bool recognises_pfm(std::string_view bytes) {
    return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') && is_space(bytes[2]);
}

ImageFile decode_pfm(const Path& file, std::string_view bytes) {
    HeaderWords header(file, bytes);
    const auto width = header.next<long long>("width");
    const auto height = header.next<long long>("height");
    const auto scale = header.next<double>("scale");
    check_size(file, width, height);
    if (scale == 0 || scale != scale)
        fail(file, "damaged PFM header: the scale must not be 0 (its sign is the byte order)");

    const int channels = bytes[1] == 'F' ? 3 : 1;
    const auto count = static_cast<std::size_t>(width * height * channels);
    const std::size_t there = bytes.size() - std::min(bytes.size(), header.end());
    if (there < count * sizeof(float))
        fail(file, fmt::format("truncated: {} bytes of pixels where {} x {} x {} floats need {}", there,
                               width, height, channels, count * sizeof(float)));
    ImageFile decoded{.image = Image(static_cast<int>(width), static_cast<int>(height), channels)};
    Image& image = decoded.image;
    // "The units of the samples", of which nobody says what they are; readers leave the samples as they are.
    if (std::abs(scale) != 1)
        decoded.warnings.push_back(fmt::format("PFM scale {}: not multiplied by", std::abs(scale)));
    char* values = reinterpret_cast<char*>(image.values.data());
    std::memcpy(values, bytes.data() + header.end(), count * sizeof(float));
    if ((scale < 0) != little_endian_machine) swap_bytes(values, count);
    return decoded;
}

ImageFile read_pfm(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return decode_pfm(source.name, source.bytes);
}

ImageDescription describe_pfm(const ImageSource& source) {
    const ImageFile file = decode_pfm(source.name, source.bytes);
    ImageDescription description = description_of_one(pfm.name, file.image, "float");
    description.warnings = file.warnings;
    return description;
}

} // namespace

const Format pfm = {"PFM", recognises_pfm, read_pfm, describe_pfm};

std::string pfm_bytes(const Image& image) {
    std::string bytes =
        fmt::format("{}\n{} {}\n-1.0\n", image.channels == 3 ? "PF" : "Pf", image.width, image.height);
    const std::size_t begin = bytes.size();
    bytes.append(reinterpret_cast<const char*>(image.values.data()), image.values.size() * sizeof(float));
    if (!little_endian_machine) swap_bytes(bytes.data() + begin, image.values.size());
    return bytes;
}

} // namespace postfx::formats
