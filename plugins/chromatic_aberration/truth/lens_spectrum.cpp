#include "lens_spectrum.hpp"

#include <cmath>

namespace postfx::host {

LensSpectrum::LensSpectrum(double strength, int width, int height) {
    const auto index = [](double micrometres) { return 1 / (micrometres * micrometres); };
    const double red = index(0.612), green = index(0.549), blue = index(0.464);
    const double heights_to_corner = std::hypot(width, height) / 2 / height;
    red_end_ = strength / heights_to_corner * (red - green) / (blue - red);
    blue_end_ = strength / heights_to_corner * (blue - green) / (blue - red);
}

double LensSpectrum::displacement(int channel, double quantile) const {
    // Density 2t over 0..1 has the quantiles sqrt(q), 2 (1 - t) has 1 - sqrt(1 - q).
    if (channel == 0) return red_end_ * std::sqrt(quantile);
    if (channel == 2) return blue_end_ * std::sqrt(quantile);
    if (quantile < 0.5) return red_end_ * (1 - std::sqrt(1 - 2 * quantile));
    return blue_end_ * (1 - std::sqrt(2 - 2 * quantile));
}

} // namespace postfx::host
