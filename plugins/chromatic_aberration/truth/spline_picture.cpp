#include "spline_picture.hpp"

#include <truths/fourier.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace postfx::host {
namespace {

/// Pixels around the picture that repeat its edge. What a pixel does to the spline falls by 0.43 per pixel: beyond
/// the margin's middle, 1e-6 is left of it.
constexpr int margin = 32;

/// What a wave of `frequency` radians per pixel becomes when its values are taken for coefficients: B-splines of
/// degree 5 are 66, 26 and 1 of 120 at the integers.
double response(double frequency) {
    return (66 + 52 * std::cos(frequency) + 2 * std::cos(2 * frequency)) / 120;
}

double fifth_power(double x) {
    return x * x * x * x * x;
}

/// B-spline of degree 5, |x| <= 3: truncated powers from the nearer end.
double b_spline(double x) {
    const double t = 3 - std::abs(x);
    return (fifth_power(t) - 6 * fifth_power(std::max(0.0, t - 1)) + 15 * fifth_power(std::max(0.0, t - 2)))
           / 120;
}

/// The six coefficients along an axis that count at a place, and how much.
struct Taps {
    int first;
    std::array<double, 6> weights;

    Taps(double place, int count) {
        // Half a margin outside, all is the edge.
        const double inside = std::clamp(place + margin, margin / 2.0, count - margin / 2.0);
        const double left = std::floor(inside - 0.5);
        first = static_cast<int>(left) - 2;
        for (std::size_t i = 0; i < 6; ++i)
            weights[i] = b_spline(inside - 0.5 - left + 2 - static_cast<double>(i));
    }
};

} // namespace

SplinePicture::SplinePicture(Image64 picture)
    : picture_(std::move(picture)),
      coefficients_(picture_.width + 2 * margin, picture_.height + 2 * margin, 3) {
    const int width = coefficients_.width, height = coefficients_.height;
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> values;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                values.push_back(picture_.at(std::clamp(x - margin, 0, picture_.width - 1),
                                             std::clamp(y - margin, 0, picture_.height - 1), channel));
            }
        }
        values = cosine_waves(std::move(values), width, height);
        for (int j = 0; j < height; ++j) {
            const double along = response(std::numbers::pi * j / height);
            for (int i = 0; i < width; ++i)
                values[static_cast<std::size_t>(j) * width + i] /=
                    along * response(std::numbers::pi * i / width);
        }
        values = sum_of_waves(std::move(values), width, height);
        for (std::size_t i = 0; i < values.size(); ++i)
            coefficients_.values[3 * i + static_cast<std::size_t>(channel)] = values[i];
    }
}

double SplinePicture::at(double x, double y, int channel) const {
    const Taps across(x, coefficients_.width), up(y, coefficients_.height);
    double sum = 0;
    for (int j = 0; j < 6; ++j) {
        const double* line = coefficients_.pixel(across.first, up.first + j) + channel;
        double along = 0;
        for (std::size_t i = 0; i < 6; ++i)
            along += across.weights[i] * line[3 * i];
        sum += up.weights[static_cast<std::size_t>(j)] * along;
    }
    return sum;
}

double SplinePicture::within_neighbours(double x, double y, int channel) const {
    const int left = static_cast<int>(std::floor(x - 0.5)), below = static_cast<int>(std::floor(y - 0.5));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int j = below - 1; j <= below + 2; ++j) {
        for (int i = left - 1; i <= left + 2; ++i) {
            const double pixel = picture_.at(std::clamp(i, 0, picture_.width - 1),
                                             std::clamp(j, 0, picture_.height - 1), channel);
            low = std::min(low, pixel);
            high = std::max(high, pixel);
        }
    }
    return std::clamp(at(x, y, channel), low, high);
}

} // namespace postfx::host
