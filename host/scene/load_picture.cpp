#include "assets.hpp"

#include <image/files.hpp>
#include <image/srgb.hpp>
#include <postfx/error.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// Codes of 8 bits: those of the file, more bits rounded, and light (HDR, EXR, PFM) as sRGB shows it.
std::uint8_t code_of(float value, bool encode) {
    const double share = encode ? linear_to_srgb(value) : value > 0 ? std::min<double>(value, 1) : 0.0;
    return static_cast<std::uint8_t>(std::lround(255 * share));
}

PicturePtr picture_of(const ImageSource& source, bool srgb) {
    const ImageFile file = read_image(source, {.role = Role::texture});
    const Image& image = file.image;
    const bool encode = srgb && file.coding.numbers != Coding::Numbers::codes;
    const int colors = image.channels < 3 ? 1 : 3;
    auto picture = std::make_shared<Picture>();
    picture->width = image.width;
    picture->height = image.height;
    picture->srgb = srgb;
    picture->rgba.reserve(4 * image.pixel_count());
    for (std::size_t i = 0; i < image.values.size(); i += static_cast<std::size_t>(image.channels)) {
        const float* pixel = &image.values[i];
        for (int channel = 0; channel < 3; ++channel)
            picture->rgba.push_back(code_of(pixel[std::min(channel, colors - 1)], encode));
        picture->rgba.push_back(image.channels > colors ? code_of(pixel[colors], false) : std::uint8_t{255});
    }
    return picture;
}

} // namespace

PicturePtr decode_picture(const std::uint8_t* bytes, std::size_t size, bool srgb, const std::string& name) {
    return picture_of({name, std::string(reinterpret_cast<const char*>(bytes), size)}, srgb);
}

PicturePtr load_picture(const std::filesystem::path& file, bool srgb) {
    return picture_of(open_image(file), srgb);
}

} // namespace postfx::host
