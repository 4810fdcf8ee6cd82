// What bloom does to a point of light and to constant light.
#include "glow_kernel.hpp"

#include <truths/fourier.hpp>
#include <truths/metric.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// The entry's glow and nothing else, of all light.
ChainEntry glow_alone(const Method& method) {
    constexpr double scatter = 0;
    return entry_with(method, {{"mode", scatter}, {"intensity", 1}, {"tint", 1}, {"firefly_guard", 0}});
}

/// Sum of differences over all pixels from the exact glow of a point of light 1, the worst of several places relative
/// to coarse grids; 2 if none of the light is where it belongs.
double point_spread(const Method& method) {
    constexpr int size = 256;
    constexpr struct { int x, y; } places[] = {{128, 128}, {127, 126}, {123, 125}, {101, 117}};
    const ChainEntry entry = glow_alone(method);
    const double radius = entry.values[*entry.effect->find_parameter("radius")][0];
    const std::vector<double> shares = shares_left(GlowKernel(radius * size, 64), size, size);
    double worst = 0;
    for (const auto& [x, y] : places) {
        Image color(size, size, 3);
        std::fill_n(color.pixel(x, y), 3, 1.0f);
        const Image64 found = method.draw(entry, {.color = color});
        std::vector<double> point(static_cast<std::size_t>(size) * size);
        point[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)] = 1;
        std::vector<double> waves = cosine_waves(std::move(point), size, size);
        std::transform(waves.begin(), waves.end(), shares.begin(), waves.begin(), std::multiplies<>());
        const std::vector<double> exact = sum_of_waves(std::move(waves), size, size);
        double sum = 0;
        for (std::size_t i = 0; i < exact.size(); ++i)
            sum += std::abs(found.values[3 * i + 1] - exact[i]);
        worst = std::max(worst, sum);
    }
    return worst;
}

/// Largest relative change of constant light.
double constant_light(const Method& method) {
    const ChainEntry entry = glow_alone(method);
    double worst = 0;
    for (const float light : {0x1p-14f, 0x1p-7f, 0.18f, 1.0f, 256.0f, 65504.0f}) {
        const Image64 found = method.draw(entry, {.color = Image(96, 54, 3, light)});
        for (const double value : found.values)
            worst = std::max(worst, std::abs(value / static_cast<double>(light) - 1));
    }
    return worst;
}

const RegisterMetric
    spread_metric("bloom", "psf_l1", "",
                  "sum of differences from the exact glow of a point of light in 256x256 pixels",
                  point_spread),
    constant_metric("bloom", "dc_gain", "", "largest relative change of constant light", constant_light);

} // namespace
} // namespace postfx::host
