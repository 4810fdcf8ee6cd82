#include <image/alpha.hpp>

namespace postfx {

Image with_alpha(Image image, Coding::Alpha from, Coding::Alpha to) {
    const bool has_alpha = image.channels == 2 || image.channels == 4;
    if (!has_alpha || from == to || from == Coding::Alpha::none || to == Coding::Alpha::none) return image;
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < image.values.size(); i += channels) {
        const float alpha = image.values[i + channels - 1];
        if (to == Coding::Alpha::straight && alpha == 0) continue;
        for (std::size_t channel = 0; channel + 1 < channels; ++channel) {
            float& value = image.values[i + channel];
            value = to == Coding::Alpha::straight ? value / alpha : value * alpha;
        }
    }
    return image;
}

} // namespace postfx
