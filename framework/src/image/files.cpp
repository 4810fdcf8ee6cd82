#include <base/read_file.hpp>
#include <image/files.hpp>
#include <image/formats.hpp>

#include <fmt/format.h>

#include <array>
#include <new>

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

void check_plausible(const ImageSource& source, long long pixels) {
    constexpr long long always_allowed = 7680LL * 4320, densest = 1LL << 15;
    if (pixels <= always_allowed || pixels / densest <= static_cast<long long>(source.bytes.size())) return;
    fail(source.name, fmt::format("absurd size: {} bytes can't be a picture of {} million pixels",
                                  source.bytes.size(), pixels / 1000000));
}

void expect_no_layers(const ImageSource& source, const ImageRequest& request) {
    for (const std::string& wish : {request.layer, request.view})
        if (!wish.empty())
            fail(source.name,
                 fmt::format("only EXR files have layers and views, so there is no \"{}\" in it", wish));
}

ImageDescription description_of_one(const char* kind, const Image& image, const std::string& type) {
    static const char* const names[5][4] = {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    LayerDescription layer;
    for (int channel = 0; channel < image.channels; ++channel)
        layer.channels.push_back({names[image.channels][channel], type});
    ImageDescription description{
        .kind = kind, .parts = {{.width = image.width, .height = image.height}}, .layers = {layer}};
    for (const Role role : {Role::color, Role::depth, Role::normal, Role::emission, Role::ambient})
        description.roles.push_back({.role = role});
    return description;
}

} // namespace formats

namespace {

using formats::fail;
using formats::Path;

/// The largest file that is read: 2^28 pixels of four floats and further layers. A pipe or a device, whose size nobody
/// knows before, may give an eighth of it.
std::size_t max_bytes(const Path& file) {
    constexpr std::size_t largest = std::size_t{1} << 33;
    return is_stream(file) ? largest / 8 : largest;
}

/// Every kind of file that is known; the first one that recognises the bytes reads them.
constexpr std::array known_formats = {&formats::png,  &formats::jpeg, &formats::heic, &formats::tiff,
                                      &formats::webp, &formats::exr,  &formats::hdr,  &formats::pfm,
                                      &formats::pnm,  &formats::stb};

const formats::Format& format_of(const ImageSource& source) {
    for (const formats::Format* format : known_formats)
        if (format->recognises(source.bytes)) return *format;
    std::vector<std::string> names;
    for (const formats::Format* format : known_formats)
        names.emplace_back(format->name);
    fail(source.name, fmt::format("is not an image of a known kind ({})", fmt::join(names, ", ")));
}

} // namespace

ImageSource open_image(const std::filesystem::path& file) {
    try {
        ImageSource source{file, read_file(file, max_bytes(file), "an image")};
        if (source.bytes.empty()) fail(file, "is empty");
        return source;
    } catch (const std::bad_alloc&) {
        fail(file, "not enough memory for this picture");
    }
}

ImageFile read_image(const ImageSource& source, const ImageRequest& request) {
    try {
        return format_of(source).read(source, request);
    } catch (const std::bad_alloc&) {
        fail(source.name, "not enough memory for this picture");
    }
}

ImageFile read_image(const std::filesystem::path& file, const ImageRequest& request) {
    return read_image(open_image(file), request);
}

ImageDescription describe_image(const ImageSource& source) {
    return format_of(source).describe(source);
}

} // namespace postfx
