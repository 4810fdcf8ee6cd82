// Radiance pictures (G. Ward, "Real pixels", Graphics Gems II, 1991). A decoder of our own, because
// stb_image's takes the end of a file for zeros: a truncated picture reads as a whole one, or forever.
#include <image/color_space.hpp>
#include <image/formats.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

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

/// Scanlines run along one axis in one direction, and follow each other along the other: "-Y 2 +X 3" is two rows
/// from the top, each from the left.
struct Resolution {
    bool columns = false; ///< a scanline is a column
    bool from_top = true, from_left = true;
    int lines = 0, length = 0; ///< how many, of how many pixels

    int width() const { return columns ? lines : length; }
    int height() const { return columns ? length : lines; }
};

Resolution resolution_of(const Path& file, const std::string& line) {
    char signs[2] = {}, axes[2] = {};
    long long sizes[2] = {};
    const int found = std::sscanf(line.c_str(), "%c%c %12lld %c%c %12lld", &signs[0], &axes[0], &sizes[0],
                                  &signs[1], &axes[1], &sizes[1]);
    const auto is_sign = [](char c) { return c == '-' || c == '+'; };
    const bool axes_good = (axes[0] == 'Y' && axes[1] == 'X') || (axes[0] == 'X' && axes[1] == 'Y');
    if (found != 6 || !axes_good || !is_sign(signs[0]) || !is_sign(signs[1]))
        fail(file, "its HDR resolution line is not of the form \"-Y height +X width\"");
    const std::size_t y = axes[0] == 'Y' ? 0 : 1;
    check_size(file, sizes[1 - y], sizes[y]);
    return {.columns = y == 1,
            .from_top = signs[y] == '-',
            .from_left = signs[1 - y] == '+',
            .lines = static_cast<int>(sizes[0]),
            .length = static_cast<int>(sizes[1])};
}

/// What the lines of the header say of the pixels.
struct Statements {
    bool xyz = false;
    double exposure = 1;                       ///< the product of all lines: what pixels were multiplied by
    std::array<double, 3> correction{1, 1, 1}; ///< likewise for each channel
    double pixel_aspect = 1;                   ///< height over width, as the format has it
    std::optional<Chromaticities> primaries{};
    std::vector<std::pair<std::string, std::string>> attributes{};
    std::vector<std::string> warnings{};
};

/// Up to `count` numbers of a line; empty where one is missing.
std::vector<double> numbers_of(const std::string& text, std::size_t count) {
    std::vector<double> numbers;
    const char* at = text.c_str();
    for (std::size_t i = 0; i < count; ++i) {
        char* end = nullptr;
        numbers.push_back(std::strtod(at, &end));
        if (end == at || !std::isfinite(numbers.back())) return {};
        at = end;
    }
    return numbers;
}

bool all_positive(const std::vector<double>& numbers) {
    return !numbers.empty() && std::all_of(numbers.begin(), numbers.end(), [](double x) { return x > 0; });
}

void take_format(const Path& file, std::string value, Statements& said) {
    std::erase(value, ' ');
    said.xyz = value == "32-bit_rle_xyze";
    if (!said.xyz && value != "32-bit_rle_rgbe")
        fail(file, "its HDR pixels are neither RGBE nor XYZE but " + value);
}

/// One line "NAME=value"; a name that says nothing of the pixels is an attribute.
void take_line(const Path& file, const std::string& name, const std::string& value, Statements& said) {
    const std::size_t counts = name == "COLORCORR" ? 3 : name == "PRIMARIES" ? 8 : 1;
    const std::vector<double> numbers = numbers_of(value, counts);
    if (name == "FORMAT") return take_format(file, value, said);
    said.attributes.emplace_back(name, value);
    if (name == "PRIMARIES" && !numbers.empty()) {
        said.primaries = Chromaticities{{numbers[0], numbers[1]},
                                        {numbers[2], numbers[3]},
                                        {numbers[4], numbers[5]},
                                        {numbers[6], numbers[7]}};
        return;
    }
    const bool known =
        name == "EXPOSURE" || name == "COLORCORR" || name == "PIXASPECT" || name == "PRIMARIES";
    if (known && !all_positive(numbers)) {
        said.warnings.push_back(fmt::format("HDR {}={} means nothing; not followed", name, value));
    } else if (name == "EXPOSURE") {
        said.exposure *= numbers[0];
    } else if (name == "COLORCORR") {
        for (std::size_t i = 0; i < 3; ++i)
            said.correction[i] *= numbers[i];
    } else if (name == "PIXASPECT") {
        said.pixel_aspect *= numbers[0];
    }
}

Statements read_statements(const Path& file, Bytes& bytes) {
    Statements said;
    bytes.line(); // "#?RADIANCE"
    for (std::string line = bytes.line(); !line.empty(); line = bytes.line()) {
        const std::size_t equals = line.find('=');
        // Other lines are commands that made the picture, and comments.
        if (equals != std::string::npos && line[0] != '#')
            take_line(file, line.substr(0, equals), line.substr(equals + 1), said);
    }
    return said;
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

float value_of(std::uint8_t mantissa, std::uint8_t exponent) {
    return exponent == 0 ? 0.0f : std::ldexp(static_cast<float>(mantissa), exponent - (128 + 8));
}

Image read_pixels(const Resolution& size, Bytes& bytes) {
    Image image(size.width(), size.height(), 3);
    std::vector<Rgbe> line(static_cast<std::size_t>(size.length));
    for (int i = 0; i < size.lines; ++i) {
        read_row(bytes, line);
        for (int j = 0; j < size.length; ++j) {
            const int along_x = size.columns ? i : j, along_y = size.columns ? j : i;
            float* to = image.pixel(size.from_left ? along_x : image.width - 1 - along_x,
                                    size.from_top ? image.height - 1 - along_y : along_y);
            const Rgbe& pixel = line[static_cast<std::size_t>(j)];
            for (std::size_t channel = 0; channel < 3; ++channel)
                to[channel] = value_of(pixel[channel], pixel[3]);
        }
    }
    return image;
}

/// To the light that was there before somebody exposed and corrected it.
void undo_exposure(const Statements& said, ImageFile& file) {
    const std::array<double, 3>& c = said.correction;
    if (said.exposure == 1 && c == std::array<double, 3>{1, 1, 1}) return;
    for (std::size_t i = 0; i < file.image.values.size(); ++i)
        file.image.values[i] = static_cast<float>(file.image.values[i] / (said.exposure * c[i % 3]));
    if (said.exposure != 1)
        file.honoured.push_back(fmt::format("HDR EXPOSURE: divided by {}", said.exposure));
    if (c != std::array<double, 3>{1, 1, 1})
        file.honoured.push_back(fmt::format("HDR COLORCORR: divided by {} {} {}", c[0], c[1], c[2]));
}

void convert_primaries(const Statements& said, Adaptation adaptation, ImageFile& file) {
    // Radiance's XYZ has equal energy as white.
    constexpr Chromaticities xyz = {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0, 1 / 3.0}};
    const Chromaticities space = said.xyz ? xyz : said.primaries.value_or(rec709_chromaticities);
    if (is_rec709(space)) return;
    const std::optional<ColorMatrix> matrix = matrix_to_rec709(space, adaptation);
    if (!matrix) {
        file.warnings.emplace_back("HDR PRIMARIES make no colour space; not followed");
        return;
    }
    convert_colors(file.image, *matrix);
    file.honoured.emplace_back(said.xyz ? "HDR XYZE: converted to Rec. 709"
                                        : "HDR PRIMARIES: converted to Rec. 709");
}

struct Decoded {
    ImageFile file{};
    Statements said{};
};

Decoded decode_hdr(const ImageSource& source, const ImageRequest& request) {
    Bytes bytes(source.name, source.bytes);
    Decoded decoded{.said = read_statements(source.name, bytes)};
    const Statements& said = decoded.said;
    ImageFile& file = decoded.file;
    file.image = read_pixels(resolution_of(source.name, bytes.line()), bytes);
    file.warnings = said.warnings;
    if (said.pixel_aspect != 1) file.shot.pixel_aspect_ratio = 1 / said.pixel_aspect;
    if (request.role == Role::color) tell_pixel_shape(file);
    if (!is_light(request.role)) return decoded;
    undo_exposure(said, file);
    convert_primaries(said, request.adaptation, file);
    return decoded;
}

bool recognises_hdr(std::string_view bytes) {
    // Behind "#?" stands the name of whatever program wrote it.
    return bytes.starts_with("#?");
}

ImageFile read_hdr(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return decode_hdr(source, request).file;
}

ImageDescription describe_hdr(const ImageSource& source) {
    const Decoded decoded = decode_hdr(source, {});
    ImageDescription description =
        description_of_one(hdr.name, decoded.file.image, "8 bit with a common exponent");
    description.parts.front().attributes = decoded.said.attributes;
    description.honoured = decoded.file.honoured;
    description.warnings = decoded.file.warnings;
    return description;
}

} // namespace

const Format hdr = {"HDR", recognises_hdr, read_hdr, describe_hdr};

std::string hdr_bytes(const Image& rgb) {
    std::string bytes = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"
                                    "PRIMARIES=0.6400 0.3300 0.3000 0.6000 0.1500 0.0600 0.3127 0.3290\n"
                                    "\n-Y {} +X {}\n",
                                    rgb.height, rgb.width);
    std::vector<Rgbe> row(static_cast<std::size_t>(rgb.width));
    for (int y = rgb.height - 1; y >= 0; --y) {
        for (int x = 0; x < rgb.width; ++x)
            row[static_cast<std::size_t>(x)] = encode(rgb.pixel(x, y));
        append_row(bytes, row);
    }
    return bytes;
}

} // namespace postfx::formats
