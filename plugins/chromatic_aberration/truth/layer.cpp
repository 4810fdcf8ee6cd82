// Lateral chromatic aberration of the picture that the effect is given: wavelength by wavelength, each with its own
// magnification.
#include "lens_spectrum.hpp"
#include "spline_picture.hpp"

#include <image/rows.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/sampling.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::host {
namespace {

/// What light counts for: no number as black, nothing beyond the largest half float.
double counted(double light) {
    return std::isnan(light) ? 0 : std::clamp(light, -65504.0, 65504.0);
}

Image64 counted(Image64 light) {
    for (double& value : light.values)
        value = counted(value);
    return light;
}

class Wavelengths : public Truth {
public:
    explicit Wavelengths(const TruthRequest& request)
        : width_(request.width), height_(request.height), strength_(request.value("strength")),
          spectrum_(strength_, request.width, request.height),
          axis_(request.scene.camera_at(request.time).principal_point),
          picture_(counted(given_light(request))) {}

    std::string description(int samples) const override {
        return fmt::format(
            "{} wavelengths per channel and pixel; the picture rebuilt between its pixels by a spline of "
            "degree 5 within the range of 4x4 pixels, its edge going on outside",
            samples);
    }
    std::string values() const override { return fmt::format("strength {}", strength_); }
    int channels() const override { return 3; }

    void add(int index, Image64& sum) override {
        for_each_row(sum.height, [&](int y) {
            for (int x = 0; x < sum.width; ++x) {
                // Each pixel has its own sequence of wavelengths: their error is noise, not a ghost.
                const auto pixel = static_cast<std::uint32_t>(y * sum.width + x);
                const double quantile = truth_point(index, pixel).x;
                for (int channel = 0; channel < 3; ++channel)
                    sum.at(x, y, channel) += seen(x, y, channel, quantile);
            }
        });
    }

    Image64 picture(const Image64& sum, int count) const override {
        Image64 mean = sum;
        for (double& value : mean.values)
            value = counted(value / count);
        return mean;
    }

private:
    double seen(int x, int y, int channel, double quantile) const {
        const double scale = 1 + spectrum_.displacement(channel, quantile);
        const double axis_x = width_ / 2.0 * (1 + axis_[0]), axis_y = height_ / 2.0 * (1 + axis_[1]);
        return picture_.within_neighbours(axis_x + (x + 0.5 - axis_x) * scale,
                                          axis_y + (y + 0.5 - axis_y) * scale, channel);
    }

    int width_, height_;
    double strength_;
    LensSpectrum spectrum_;
    std::array<double, 2> axis_; ///< as Camera::principal_point
    SplinePicture picture_;
};

const RegisterTruth<Wavelengths>
    registered("chromatic_aberration", "layer",
               "1024 wavelengths over the picture, rebuilt between its pixels by a spline of degree 5", 1024);

} // namespace
} // namespace postfx::host
