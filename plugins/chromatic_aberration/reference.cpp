// The lateral aberration's model in float64: a spectrum of samples along the radius, weighted by integrating
// each channel's kernel over the linear interpolation between samples.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::testing {
namespace {

enum Level { classic, low, medium, high, ultra, most };

double counted(double value) {
    return std::isnan(value) ? 0 : std::clamp(value, -65504.0, 65504.0);
}

double texel(const Image64& image, double i, double j, int channel) {
    return image.at(static_cast<int>(std::clamp(i, 0.0, image.width - 1.0)),
                    static_cast<int>(std::clamp(j, 0.0, image.height - 1.0)), channel);
}

/// The value at 0 < t < 1 between the middle two of n samples at integers, by cubic convolution.
/// Four: the cubic with those values and, as slopes, half the difference of each one's neighbours.
double between(const std::array<double, 4>& v, double t) {
    const double m0 = (v[2] - v[0]) / 2, m1 = (v[3] - v[1]) / 2, s = 1 - t;
    return v[1] * (1 + 2 * t) * s * s + m0 * t * s * s + v[2] * t * t * (3 - 2 * t) - m1 * t * t * s;
}

/// Six: likewise, with slopes that are exact for cubics.
double between(const std::array<double, 6>& v, double t) {
    const auto slope = [&](int i) { return (8 * (v[i + 1] - v[i - 1]) - (v[i + 2] - v[i - 2])) / 12; };
    const double s = 1 - t;
    return v[2] * (1 + 2 * t) * s * s + slope(2) * t * s * s + v[3] * t * t * (3 - 2 * t)
           - slope(3) * t * t * s;
}

/// Kept from ringing: within the range of the middle four.
template<std::size_t n>
double held(double value, const std::array<double, n>& v) {
    const auto [least, most] = std::minmax_element(v.begin() + (n / 2 - 2), v.begin() + (n / 2 + 2));
    return std::clamp(value, *least, *most);
}

/// Edges clamped; x and y in pixels from the corner of the picture. Every pixel is counted().
template<std::size_t n>
double cubic_sample(const Image64& image, double x, double y, int channel) {
    const double left = std::floor(x - 0.5), below = std::floor(y - 0.5);
    const int half = n / 2;
    const double first = 1.0 - half;
    std::array<double, n> lines{};
    for (std::size_t j = 0; j < n; ++j) {
        std::array<double, n> line{};
        for (std::size_t i = 0; i < n; ++i) {
            line[i] = counted(texel(image, left + first + double(i), below + first + double(j), channel));
        }
        const double t = x - 0.5 - left;
        // Of four lines the first and the last are straight.
        const bool straight = n == 4 && (j == 0 || j == 3);
        lines[j] = straight ? line[1] * (1 - t) + line[2] * t : held(between(line, t), line);
    }
    return held(between(lines, y - 0.5 - below), lines);
}

/// A sample of a filtered texture is counted() as a whole.
double linear_sample(const Image64& image, double x, double y, int channel) {
    const double left = std::floor(x - 0.5), below = std::floor(y - 0.5);
    const double right_share = x - 0.5 - left, upper_share = y - 0.5 - below;
    const auto line = [&](double j) {
        return texel(image, left, j, channel) * (1 - right_share)
               + texel(image, left + 1, j, channel) * right_share;
    };
    return counted(line(below) * (1 - upper_share) + line(below + 1) * upper_share);
}

double sample(const Image64& image, double x, double y, int channel, int level) {
    if (level == high) return cubic_sample<4>(image, x, y, channel);
    if (level > high) return cubic_sample<6>(image, x, y, channel);
    return linear_sample(image, x, y, channel);
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

/// One pixel's channel `scale` larger, about the centre.
struct Place {
    const Image64& image;
    int x, y, level;

    double at(double scale, int channel) const {
        const double px = x + 0.5, py = y + 0.5;
        return sample(image, px + (px - image.width / 2.0) * scale, py + (py - image.height / 2.0) * scale,
                      channel, level);
    }
};

/// What one end of the spectrum adds to a channel: green-to-end kernel constant + slope * t, displaced by up
/// to `share` of the offset from the centre.
double half_spectrum(const Place& place, int channel, double share, double pixels, double constant,
                     double slope) {
    const double spacings[] = {1.5, 1.5, 0.75, 0.25}, limits[] = {12, 12, 48, 256};
    const int i = place.level - medium;
    const int n = static_cast<int>(std::clamp(std::ceil(std::abs(pixels) / spacings[i]), 1.0, limits[i]));
    double sum = 0;
    for (int k = 0; k <= n; ++k) {
        // The pixel itself needs no filter.
        const double value =
            k == 0 ? counted(place.image.at(place.x, place.y, channel)) : place.at(share * k / n, channel);
        sum += hat_integral(constant, slope, k, n) * value;
    }
    return sum;
}

/// 0 in focus, 1 at infinity, before half the distance and where it is not known.
double focus_value(const ReferenceInput& input, int x, int y) {
    const auto depth = input.attachments.find("depth");
    if (depth == input.attachments.end() || input.camera.focus_distance <= 0) return 1;
    const double raw = depth->second.at(x, y, 0);
    if (raw == input.camera.sky_depth) return 1;
    const double affine = raw * input.camera.depth_scale + input.camera.depth_offset;
    const double z = input.camera.orthographic ? affine : 1 / affine;
    return std::min(std::abs(z - input.camera.focus_distance) / input.camera.focus_distance, 1.0);
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const Image64& image = input.color;
    const int level = input.level_among({"classic", "low", "medium", "high", "ultra", "reference"});
    const double strength = input.value("strength");
    const auto index = [](double micrometres) { return std::pow(micrometres, -2); }; // Cauchy, up to a factor
    const double whole = index(0.464) - index(0.612);
    const double red = (index(0.612) - index(0.549)) / whole, blue = (index(0.464) - index(0.549)) / whole;
    const double diagonal = std::hypot(image.width, image.height) / 2;
    const double share = strength * image.height / diagonal, pixels = strength * image.height;
    Image64 result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Place place{image, x, y, level};
            if (level <= low) {
                const double part = level == classic ? focus_value(input, x, y) : 2 / 3.0;
                result.at(x, y, 0) = place.at(share * red * part, 0);
                result.at(x, y, 1) = counted(image.at(x, y, 1));
                result.at(x, y, 2) = place.at(share * blue * part, 2);
                continue;
            }
            const auto half = [&](int channel, double end, double constant, double slope) {
                return half_spectrum(place, channel, share * end, pixels * end, constant, slope);
            };
            result.at(x, y, 0) = half(0, red, 0, 2);
            result.at(x, y, 1) = half(1, red, 1, -1) + half(1, blue, 1, -1);
            result.at(x, y, 2) = half(2, blue, 0, 2);
        }
    }
    return result;
}

} // namespace postfx::testing
