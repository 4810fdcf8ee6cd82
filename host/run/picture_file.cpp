#include "picture_file.hpp"

#include <image/alpha.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace postfx::host {
namespace {

/// The first `channels` of each pixel.
Image first_channels(const Image& image, int channels) {
    if (image.channels == channels) return image;
    Image result(image.width, image.height, channels);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        std::copy_n(&image.values[image.channels * i], channels, &result.values[channels * i]);
    }
    return result;
}

} // namespace

Output output_for(const PictureFile& file) {
    check_writable_kind(file.path, file.kind);
    // 16 bits are encoded on the CPU, from floats: they need no dither.
    return is_display_kind(file.path, file.kind) && file.bits == 8 ? Output::display : Output::linear;
}

bool divides_by_alpha(const PictureFile& file, const Written& written) {
    return output_for(file) == Output::display && written.alpha_of_chain == Coding::Alpha::premultiplied
           && written.alpha_of_file == Coding::Alpha::straight;
}

std::vector<std::string> write_picture(ChainRunner& runner, const PictureFile& file, const Written& written) {
    const bool keeps_alpha =
        written.alpha_of_chain != Coding::Alpha::none && written.alpha_of_file != Coding::Alpha::none;
    Image picture = first_channels(runner.executor().read_picture(), keeps_alpha ? 4 : 3);
    WriteOptions options;
    options.kind = file.kind;
    options.bits = file.bits;
    options.quality = file.quality;
    if (written.origin.source) options.origin = &written.origin;
    if (runner.options().output == Output::linear) {
        if (keeps_alpha)
            picture = with_alpha(std::move(picture), written.alpha_of_chain, written.alpha_of_file);
        return write_image(file.path, picture, options);
    }
    BasicImage<std::uint8_t> codes(picture.width, picture.height, picture.channels);
    std::transform(picture.values.begin(), picture.values.end(), codes.values.begin(),
                   [](float code) { return static_cast<std::uint8_t>(std::lround(code * 255.0f)); });
    write_codes(file.path, codes, options);
    return {};
}

} // namespace postfx::host
