// The lateral aberration's model in float64: a spectrum of samples along the radius, weighted by integrating
// each channel's kernel over the linear interpolation between samples.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

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

double held(double value, double a, double b) {
    return std::clamp(value, std::min(a, b), std::max(a, b));
}

/// A line of pixels whose light is a parabola in each of them. A pixel reaches from its index to the next.
class Line {
public:
    using Pixels = std::function<double(int)>;
    Line(Pixels pixels, bool fourth_order) : pixels_(std::move(pixels)), fourth_order_(fourth_order) {}

    double mean(double from, double to) const {
        double light = 0;
        for (int i = static_cast<int>(std::floor(from)); i < to; ++i)
            light += integral(i, std::max(from, double(i)) - i, std::min(to, i + 1.0) - i);
        return light / (to - from);
    }

private:
    /// Between pixel i - 1 and i.
    double edge(int i) const {
        const double middle = (pixels_(i - 1) + pixels_(i)) / 2;
        if (!fourth_order_) return middle;
        const double outer = (pixels_(i - 2) + pixels_(i + 1)) / 2;
        return held(middle + (middle - outer) / 6, pixels_(i - 1), pixels_(i));
    }
    double bend(int i) const { return pixels_(i - 1) - 2 * pixels_(i) + pixels_(i + 1); }

    /// Of pixel i's light between two places in 0..1, by Simpson's rule, which is exact.
    double integral(int i, double from, double to) const {
        const double mean = pixels_(i);
        double left = edge(i), right = edge(i + 1);
        // By the theory a parabola of that mean stays between its ends if the mean is in their middle third.
        const double third = (right - left) / 3;
        if ((mean - left) * (right - mean) <= 0 || std::abs(2 * mean - left - right) > std::abs(third)) {
            const double second = 6 * (left + right - 2 * mean); // derivative
            double share = mean > left && mean > right ? 1 : 0;  // the top of a bright pixel stays
            if (fourth_order_ && share == 0) {
                const double sign = second < 0 ? -1 : 1;
                const double least = std::min({sign * bend(i - 1), sign * bend(i), sign * bend(i + 1)});
                share = second == 0 ? 0 : std::clamp(1.25 * least / std::abs(second), 0.0, 1.0);
            }
            double calm_left = mean, calm_right = mean;
            if ((mean - left) * (right - mean) > 0) {
                // The extremum is moved to the nearer end.
                const bool near_left = std::abs(mean - left) < std::abs(right - mean);
                calm_left = near_left ? left : mean - 2 * (right - mean);
                calm_right = near_left ? mean + 2 * (mean - left) : right;
            }
            left = share * left + (1 - share) * calm_left;
            right = share * right + (1 - share) * calm_right;
        }
        const double middle = (6 * mean - left - right) / 4; // value there
        const auto at = [&](double x) {
            return left * (1 - x) * (1 - 2 * x) + middle * 4 * x * (1 - x) + right * x * (2 * x - 1);
        };
        return (to - from) / 6 * (at(from) + 4 * at((from + to) / 2) + at(to));
    }

    Pixels pixels_;
    bool fourth_order_;
};

/// Mean over the area that a pixel shows of an image 1 + scale times as large about the axis [pixels]. Beyond the picture
/// its edge counts.
double area_mean(const Image64& image, int x, int y, double axis_x, double axis_y, double scale, int channel,
                 bool fourth_order) {
    const double left = x + scale * (x - axis_x), below = y + scale * (y - axis_y);
    const Line column(
        [&](int j) {
            const Line line([&](int i) { return counted(texel(image, i, j, channel)); }, fourth_order);
            return line.mean(left, left + 1 + scale);
        },
        fourth_order);
    return column.mean(below, below + 1 + scale);
}

double linear_sample(const Image64& image, double x, double y, int channel) {
    const double left = std::floor(x - 0.5), below = std::floor(y - 0.5);
    const double right_share = x - 0.5 - left, upper_share = y - 0.5 - below;
    const auto line = [&](double j) {
        return counted(texel(image, left, j, channel)) * (1 - right_share)
               + counted(texel(image, left + 1, j, channel)) * right_share;
    };
    return line(below) * (1 - upper_share) + line(below + 1) * upper_share;
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

/// One pixel's channel `scale` larger, about the optical axis.
struct Place {
    const Image64& image;
    double axis_x, axis_y; ///< pixels
    int x, y, level;

    double at(double scale, int channel) const {
        if (level >= high) return area_mean(image, x, y, axis_x, axis_y, scale, channel, level > high);
        const double px = x + 0.5, py = y + 0.5;
        return linear_sample(image, px + (px - axis_x) * scale, py + (py - axis_y) * scale, channel);
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
    const double share = strength * image.height / diagonal;
    const double axis_x = image.width / 2.0 * (1 + input.camera.principal_point[0]);
    const double axis_y = image.height / 2.0 * (1 + input.camera.principal_point[1]);
    const double farthest =
        std::hypot(std::max(axis_x, image.width - axis_x), std::max(axis_y, image.height - axis_y));
    const double pixels = strength * image.height * (farthest / diagonal);
    Image64 result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Place place{image, axis_x, axis_y, x, y, level};
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
            result.at(x, y, 0) = counted(half(0, red, 0, 2));
            result.at(x, y, 1) = counted(half(1, red, 1, -1) + half(1, blue, 1, -1));
            result.at(x, y, 2) = counted(half(2, blue, 0, 2));
        }
    }
    return result;
}

} // namespace postfx::testing
