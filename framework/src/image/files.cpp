#include <image/files.hpp>
#include <image/formats.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <sstream>

namespace postfx {
namespace formats {

void fail(const Path& file, const std::string& message) {
    Place place;
    place.file = file.string();
    throw Error(std::move(place), message);
}

void check_size(const Path& file, long long width, long long height) {
    // Sides first: their product could overflow.
    const bool sides_good = width >= 1 && height >= 1 && width <= max_side && height <= max_side;
    if (!sides_good || width * height > max_pixels)
        fail(file, fmt::format("absurd size: {} x {} pixels (1 to {} a side, at most {} in all)", width,
                               height, max_side, max_pixels));
}

} // namespace formats

namespace {

using formats::fail;
using formats::Path;

std::string read_bytes(const Path& file) {
    std::error_code problem;
    const auto type = std::filesystem::status(file, problem).type();
    if (type == std::filesystem::file_type::not_found) fail(file, "no such file");
    if (type == std::filesystem::file_type::directory) fail(file, "is a directory, not an image");
    // Devices may never end; a pipe is what a shell's process substitution gives.
    if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::fifo)
        fail(file, problem ? "can't be read: " + problem.message() : "is no regular file");
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(file, fmt::format("can't be opened: {}", std::strerror(errno)));
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    if (stream.bad()) fail(file, fmt::format("can't be read: {}", std::strerror(errno)));
    if (bytes.view().empty()) fail(file, "is empty");
    return std::move(bytes).str();
}

[[noreturn]] void unknown_kind(const Path& file) {
    fail(file, "is not an image of a known kind (PNG, JPEG, HDR, EXR, PFM)");
}

/// Read the file and give its bytes to `read`. A picture that does not fit into memory is an Error like any
/// other.
template<class Read>
auto with_bytes(const Path& file, Read read) {
    try {
        const std::string bytes = read_bytes(file);
        return read(bytes);
    } catch (const std::bad_alloc&) {
        fail(file, "not enough memory for this picture");
    }
}

} // namespace

ImageFile read_image(const std::filesystem::path& file) {
    return with_bytes(file, [&](const std::string& bytes) -> ImageFile {
        if (formats::is_png(bytes) || formats::is_jpeg(bytes)) {
            formats::CodedImage coded = formats::read_png_or_jpeg(file, bytes, formats::Meaning::light);
            return {std::move(coded.image), coded.was_8bit, {}};
        }
        if (formats::is_exr(bytes)) {
            formats::ExrLayers exr = formats::read_exr(file, bytes);
            return {std::move(exr.image), false, std::move(exr.layers)};
        }
        if (formats::is_hdr(bytes)) return {formats::read_hdr(file, bytes), false, {}};
        if (formats::is_pfm(bytes)) return {formats::read_pfm(file, bytes), false, {}};
        unknown_kind(file);
    });
}

Image read_data(const std::filesystem::path& file, const std::string& layer) {
    return with_bytes(file, [&](const std::string& bytes) -> Image {
        if (formats::is_exr(bytes)) return formats::read_exr_layer(file, bytes, layer);
        if (!layer.empty())
            fail(file, fmt::format("only EXR files have layers, so there is no \"{}\" in it", layer));
        if (formats::is_png(bytes) || formats::is_jpeg(bytes))
            return formats::read_png_or_jpeg(file, bytes, formats::Meaning::data).image;
        if (formats::is_hdr(bytes)) return formats::read_hdr(file, bytes);
        if (formats::is_pfm(bytes)) return formats::read_pfm(file, bytes);
        unknown_kind(file);
    });
}

} // namespace postfx
