// Radiance pictures (G. Ward, "Real pixels", Graphics Gems II, 1991). A decoder of our own, because
// stb_image's takes the end of a file for zeros: a truncated picture reads as a whole one, or forever.
#include <image/formats.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace postfx::formats {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Widths for which a row may be run-length coded channel by channel.
bool width_has_runs(int width) {
    return width >= 8 && width < 32768;
}

class Bytes {
public:
    Bytes(const Path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    std::uint8_t next() {
        if (at_ == bytes_.size()) fail(file_, "truncated: the file ends inside its pixels");
        return static_cast<std::uint8_t>(bytes_[at_++]);
    }
    Rgbe next_pixel() {
        Rgbe pixel;
        for (std::uint8_t& byte : pixel)
            byte = next();
        return pixel;
    }
    std::string line() {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos) fail(file_, "truncated: the file ends inside its header");
        std::string text(bytes_.substr(at_, end - at_));
        at_ = end + 1;
        if (!text.empty() && text.back() == '\r') text.pop_back();
        return text;
    }
    [[noreturn]] void damaged() const { fail(file_, "damaged HDR pixels: a run leaves its row"); }

private:
    const Path& file_;
    std::string_view bytes_;
    std::size_t at_ = 0;
};

struct Resolution {
    int width = 0, height = 0;
    bool top_down = true;
};

Resolution read_header(const Path& file, Bytes& bytes) {
    for (std::string line = bytes.line(); !line.empty(); line = bytes.line())
        if (line.rfind("FORMAT=", 0) == 0 && line != "FORMAT=32-bit_rle_rgbe")
            fail(file, "its HDR pixels are not RGBE but " + line.substr(7));
    const std::string line = bytes.line();
    char vertical = 0, horizontal = 0;
    long long width = 0, height = 0;
    if (std::sscanf(line.c_str(), "%cY %12lld %cX %12lld", &vertical, &height, &horizontal, &width) != 4
        || (vertical != '-' && vertical != '+') || horizontal != '+')
        fail(file, "its HDR resolution line is not of the form \"-Y height +X width\"");
    check_size(file, width, height);
    return {static_cast<int>(width), static_cast<int>(height), vertical == '-'};
}

/// Pixels one after another; in the oldest files (1, 1, 1, n) repeats the pixel before it, n times; such
/// marks in a row are the bytes of one count, lowest first.
void read_flat_row(Bytes& bytes, Rgbe first, std::vector<Rgbe>& row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        const Rgbe pixel = x == 0 && shift == 0 ? first : bytes.next_pixel();
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            row[x++] = pixel;
            shift = 0;
            continue;
        }
        const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
        if (x == 0 || shift > 8 || count > row.size() - x) bytes.damaged();
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
        x += count;
        shift += 8;
    }
}

/// One channel after the other, each in runs (count + 128, value) and literals (count, values).
void read_coded_row(Bytes& bytes, std::vector<Rgbe>& row) {
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < row.size();) {
            const std::uint8_t code = bytes.next();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128u : code;
            if (count == 0 || count > row.size() - x) bytes.damaged();
            const std::uint8_t value = run ? bytes.next() : std::uint8_t{0};
            for (std::size_t i = 0; i < count; ++i)
                row[x++][channel] = run ? value : bytes.next();
        }
}

void read_row(Bytes& bytes, std::vector<Rgbe>& row) {
    const Rgbe first = bytes.next_pixel();
    const bool coded = width_has_runs(static_cast<int>(row.size())) && first[0] == 2 && first[1] == 2
                       && (static_cast<std::size_t>(first[2]) << 8 | first[3]) == row.size();
    if (coded)
        read_coded_row(bytes, row);
    else
        read_flat_row(bytes, first, row);
}

Rgbe encode(const float* rgb) {
    // The largest value is 255 of 256 parts of 2^127: the exponent byte ends at 255.
    const float limit = std::ldexp(255.0f, 127 - 8);
    std::array<float, 3> value;
    for (std::size_t i = 0; i < 3; ++i)
        value[i] = rgb[i] > 0 ? std::min(rgb[i], limit) : 0.0f;
    const float largest = *std::max_element(value.begin(), value.end());
    int exponent = 0;
    std::frexp(largest, &exponent);
    // Rounding may carry the mantissa to 256.
    if (std::lround(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
    if (largest == 0 || exponent < -127) return {0, 0, 0, 0};
    Rgbe coded{0, 0, 0, static_cast<std::uint8_t>(exponent + 128)};
    for (std::size_t i = 0; i < 3; ++i)
        coded[i] = static_cast<std::uint8_t>(std::lround(std::ldexp(value[i], 8 - exponent)));
    return coded;
}

std::size_t run_length(const std::vector<Rgbe>& row, std::size_t x, std::size_t channel) {
    std::size_t length = 1;
    while (x + length < row.size() && length < 127 && row[x + length][channel] == row[x][channel])
        ++length;
    return length;
}

void append_coded_channel(std::string& bytes, const std::vector<Rgbe>& row, std::size_t channel) {
    constexpr std::size_t shortest_run =
        4; // a run costs two bytes and ends a literal, which costs one to resume
    for (std::size_t x = 0; x < row.size();) {
        const std::size_t run = run_length(row, x, channel);
        if (run >= shortest_run) {
            bytes += static_cast<char>(128 + run);
            bytes += static_cast<char>(row[x][channel]);
            x += run;
            continue;
        }
        const std::size_t begin = x;
        while (x < row.size() && x - begin < 128 && run_length(row, x, channel) < shortest_run)
            ++x;
        bytes += static_cast<char>(x - begin);
        for (std::size_t i = begin; i < x; ++i)
            bytes += static_cast<char>(row[i][channel]);
    }
}

void append_row(std::string& bytes, const std::vector<Rgbe>& row) {
    if (!width_has_runs(static_cast<int>(row.size()))) {
        for (const Rgbe& pixel : row)
            bytes.append(pixel.begin(), pixel.end());
        return;
    }
    bytes += {2, 2, static_cast<char>(row.size() >> 8), static_cast<char>(row.size() & 255)};
    for (std::size_t channel = 0; channel < 4; ++channel)
        append_coded_channel(bytes, row, channel);
}

bool recognises_hdr(std::string_view bytes) {
    return bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE");
}

Image decode_hdr(const Path& file, std::string_view data) {
    Bytes bytes(file, data);
    const Resolution size = read_header(file, bytes);
    Image image(size.width, size.height, 3);
    std::vector<Rgbe> row(static_cast<std::size_t>(size.width));
    for (int i = 0; i < size.height; ++i) {
        read_row(bytes, row);
        float* to = image.pixel(0, size.top_down ? size.height - 1 - i : i);
        for (const Rgbe& pixel : row)
            for (std::size_t channel = 0; channel < 3; ++channel)
                *to++ = pixel[3] == 0 ? 0.0f
                                      : std::ldexp(static_cast<float>(pixel[channel]), pixel[3] - (128 + 8));
    }
    return image;
}

ImageFile read_hdr(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return {.image = decode_hdr(source.name, source.bytes)};
}

ImageDescription describe_hdr(const ImageSource& source) {
    return description_of_one(hdr.name, decode_hdr(source.name, source.bytes),
                              "8 bit with a common exponent");
}

} // namespace

const Format hdr = {"HDR", recognises_hdr, read_hdr, describe_hdr};

std::string hdr_bytes(const Image& rgb) {
    std::string bytes =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", rgb.height, rgb.width);
    std::vector<Rgbe> row(static_cast<std::size_t>(rgb.width));
    for (int y = rgb.height - 1; y >= 0; --y) {
        for (int x = 0; x < rgb.width; ++x)
            row[static_cast<std::size_t>(x)] = encode(rgb.pixel(x, y));
        append_row(bytes, row);
    }
    return bytes;
}

} // namespace postfx::formats
