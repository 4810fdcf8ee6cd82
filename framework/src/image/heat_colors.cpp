#include <image/heat_colors.hpp>

#include <image/cielab.hpp>
#include <image/srgb.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace postfx {
namespace {

using Codes = std::array<std::uint8_t, 3>;

/// A path through L*a*b*: lightness rises straight, the hue turns from violet (290 degrees) to yellow (460),
/// the chroma is a parabola that is 0 at both ends and no larger than sRGB can show in between.
Codes heat_color(double error) {
    if (!std::isfinite(error)) return {0, 255, 0};
    const double t = std::clamp(error, 0.0, 1.0);
    const double hue = (290 + 170 * t) * std::numbers::pi / 180, chroma = 4 * 64 * t * (1 - t);
    const Triple linear = xyz_to_linear(lab_to_xyz({98 * t, chroma * std::cos(hue), chroma * std::sin(hue)}));
    Codes codes{};
    std::transform(linear.begin(), linear.end(), codes.begin(), [](double light) {
        return static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(light)));
    });
    return codes;
}

} // namespace

std::vector<std::uint8_t> heat_colors(const Image& errors) {
    std::vector<std::uint8_t> codes;
    codes.reserve(errors.pixel_count() * 3);
    for (std::size_t i = 0; i < errors.pixel_count(); ++i) {
        const Codes color = heat_color(errors.values[i * static_cast<std::size_t>(errors.channels)]);
        codes.insert(codes.end(), color.begin(), color.end());
    }
    return codes;
}

} // namespace postfx
