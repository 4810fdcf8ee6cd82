// The lateral aberration's model in float64: a spectrum of samples along the radius, weighted by integrating
// each channel's kernel over the linear interpolation between samples.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::testing {
namespace {

double counted(double value) {
    if (std::isnan(value)) return 0;
    return std::isinf(value) ? std::copysign(65504.0, value) : value;
}

/// Bilinear, edges clamped; x and y in pixels from the corner of the picture. A sample is counted() as a
/// whole.
double sample(const Image64& image, double x, double y, int channel) {
    const double left = std::floor(x - 0.5), below = std::floor(y - 0.5);
    const auto texel = [&](double i, double j) {
        return image.at(static_cast<int>(std::clamp(i, 0.0, image.width - 1.0)),
                        static_cast<int>(std::clamp(j, 0.0, image.height - 1.0)), channel);
    };
    const double right_share = x - 0.5 - left, upper_share = y - 0.5 - below;
    const double lower = texel(left, below) * (1 - right_share) + texel(left + 1, below) * right_share;
    const double upper =
        texel(left, below + 1) * (1 - right_share) + texel(left + 1, below + 1) * right_share;
    return counted(lower * (1 - upper_share) + upper * upper_share);
}

/// Integrals over 0..1 of (constant + slope * t) times the hat function of node k of n + 1, by Simpson's
/// rule, which is exact for the products.
double hat_integral(double constant, double slope, int k, int n) {
    double sum = 0;
    for (int cell : {k - 1, k}) {
        if (cell < 0 || cell >= n) continue;
        const double from = double(cell) / n, to = double(cell + 1) / n, middle = (from + to) / 2;
        const double hat_from = cell == k ? 1 : 0, hat_to = 1 - hat_from;
        sum += (to - from) / 6
               * ((constant + slope * from) * hat_from + 4 * (constant + slope * middle) * 0.5
                  + (constant + slope * to) * hat_to);
    }
    return sum;
}

/// What one end of the spectrum adds to a channel: green-to-end kernel constant + slope * t, displaced by up
/// to `share` of the offset from the centre.
double half_spectrum(const Image64& image, int x, int y, int channel, double share, double pixels,
                     double constant, double slope) {
    const int n = static_cast<int>(std::clamp(std::ceil(std::abs(pixels) / 1.5), 1.0, 12.0));
    const double px = x + 0.5, py = y + 0.5;
    double sum = 0;
    for (int k = 0; k <= n; ++k) {
        const double scale = share * k / n;
        sum += hat_integral(constant, slope, k, n)
               * sample(image, px + (px - image.width / 2.0) * scale, py + (py - image.height / 2.0) * scale,
                        channel);
    }
    return sum;
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const Image64& image = input.color;
    const double strength = input.value("strength");
    const auto index = [](double micrometres) { return std::pow(micrometres, -2); }; // Cauchy, up to a factor
    const double whole = index(0.464) - index(0.612);
    const double red = (index(0.612) - index(0.549)) / whole, blue = (index(0.464) - index(0.549)) / whole;
    const double diagonal = std::hypot(image.width, image.height) / 2;
    const double share = strength * image.height / diagonal, pixels = strength * image.height;
    Image64 result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto half = [&](int channel, double end, double constant, double slope) {
                return half_spectrum(image, x, y, channel, share * end, pixels * end, constant, slope);
            };
            result.at(x, y, 0) = half(0, red, 0, 2);
            result.at(x, y, 1) = half(1, red, 1, -1) + half(1, blue, 1, -1);
            result.at(x, y, 2) = half(2, blue, 0, 2);
        }
    }
    return result;
}

} // namespace postfx::testing
