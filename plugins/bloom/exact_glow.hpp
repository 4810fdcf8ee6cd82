// The glow by exact convolution, for tests: what every level approaches.
#pragma once

#include <postfx/image.hpp>

#include <cmath>
#include <numbers>

namespace postfx::testing {

/// What the effect is to approach: shares of a row or column (discrete cosine transform, whose border is a mirror)
/// shrink by e^(-v (1 - cos w)) in a Gaussian of the variance v (Lindeberg 1990), and variances are v = 5 d^2 t^4
/// with t spread evenly over 0..1, so that the mean is d^2, the square of the standard deviation.
class ExactGlow {
public:
    ExactGlow(int width, int height, double deviation)
        : width_(width), height_(height), share_(width, height, 1) {
        constexpr int samples = 200;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double loss =
                    2 - std::cos(std::numbers::pi * x / width) - std::cos(std::numbers::pi * y / height);
                double sum = 0;
                for (int i = 0; i < samples; ++i)
                    sum += std::exp(-5 * deviation * deviation * std::pow((i + 0.5) / samples, 4) * loss);
                share_.at(x, y, 0) = sum / samples;
            }
        }
    }
    /// Of channel 0.
    Image64 glow_of(const Image64& light) const {
        Image64 waves = transformed(light, false);
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x)
                waves.at(x, y, 0) *= share_.at(x, y, 0);
        }
        return transformed(waves, true);
    }

private:
    static double wave(int place, int frequency, int size) {
        const double scale = std::sqrt((frequency == 0 ? 1.0 : 2.0) / size);
        return scale * std::cos(std::numbers::pi * frequency * (place + 0.5) / size);
    }
    static Image64 waves_of(int size, bool back) {
        Image64 table(size, size, 1);
        for (int to = 0; to < size; ++to) {
            for (int from = 0; from < size; ++from)
                table.at(from, to, 0) = back ? wave(to, from, size) : wave(from, to, size);
        }
        return table;
    }
    Image64 transformed(const Image64& image, bool back) const {
        const Image64 across = waves_of(width_, back), along = waves_of(height_, back);
        Image64 rows(width_, height_, 1), result(width_, height_, 1);
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                for (int i = 0; i < width_; ++i)
                    rows.at(x, y, 0) += across.at(i, x, 0) * image.at(i, y, 0);
            }
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                for (int i = 0; i < height_; ++i)
                    result.at(x, y, 0) += along.at(i, y, 0) * rows.at(x, i, 0);
            }
        }
        return result;
    }

    int width_, height_;
    Image64 share_;
};

} // namespace postfx::testing
