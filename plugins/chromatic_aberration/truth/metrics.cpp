// Where a lens puts edges, and how much light it keeps, on pictures that are known between their pixels.
#include "lens_spectrum.hpp"

#include <truths/metric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace postfx::host {
namespace {

constexpr int width = 512, height = 288;
constexpr double strength = 0.01; // 3 pixels from red to blue in the corner, as 0.003 has at 1080 rows

ChainEntry lens(const Method& method) {
    return entry_with(method, {{"strength", strength}});
}

/// A channel's mean of f(magnification).
double over_kernel(int channel, const std::function<double(double)>& f) {
    static const LensSpectrum spectrum(strength, width, height);
    constexpr int wavelengths = 4096; // f is smooth: the mean is right to 1e-9
    double sum = 0;
    for (int i = 0; i < wavelengths; ++i)
        sum += f(1 + spectrum.displacement(channel, (i + 0.5) / wavelengths));
    return sum / wavelengths;
}

/// Largest distance [px] of an edge's centroid from its place, over channels and edges left, right, below and above
/// the centre. An edge at a from the centre is seen at a / magnification.
double edge_position(const Method& method) {
    double worst = 0;
    for (const double edge : {-200.3, -77.6, 120.5, 230.0}) {
        for (const bool is_upright : {true, false}) {
            const int length = is_upright ? width : height;
            const double place = is_upright ? edge : edge * height / width; // from the centre
            Image color(width, height, 3);
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const double pixel = is_upright ? x : y;
                    const double lit = std::clamp(length / 2.0 + place - pixel, 0.0, 1.0);
                    std::fill_n(color.pixel(x, y), 3, static_cast<float>(lit));
                }
            }
            const Image64 found = method.draw(lens(method), {.color = color});
            for (int channel = 0; channel < 3; ++channel) {
                const double expected =
                    length / 2.0 + place * over_kernel(channel, [](double m) { return 1 / m; });
                // How far the light reaches: its sum along a line. Lines through a quarter, the middle, three
                // quarters.
                for (int quarter = 1; quarter <= 3; ++quarter) {
                    double reach = 0;
                    for (int i = 0; i < length; ++i)
                        reach += is_upright ? found.at(i, quarter * height / 4, channel)
                                            : found.at(quarter * width / 4, i, channel);
                    worst = std::max(worst, std::abs(reach - expected));
                }
            }
        }
    }
    return worst;
}

/// Largest relative error of a channel's light, of a blob well inside the picture: magnified light shrinks by the
/// square.
double channel_energy(const Method& method) {
    Image color(width, height, 3);
    double light = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double distance = std::hypot(x - 410.3, y - 70.6);
            const auto value = static_cast<float>(std::exp(-distance * distance / (2 * 2.5 * 2.5)));
            std::fill_n(color.pixel(x, y), 3, value);
            light += static_cast<double>(value);
        }
    }
    const Image64 found = method.draw(lens(method), {.color = color});
    std::array<double, 3> sums{};
    for (std::size_t i = 0; i < found.values.size(); ++i)
        sums[i % 3] += found.values[i];
    double worst = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const double expected = light * over_kernel(channel, [](double m) { return 1 / (m * m); });
        worst = std::max(worst, std::abs(sums[static_cast<std::size_t>(channel)] / expected - 1));
    }
    return worst;
}

const RegisterMetric edge_metric("chromatic_aberration", "edge_position", "px",
                                 "largest error of an edge's place in a channel, strength 0.01 at 512x288",
                                 edge_position),
    energy_metric("chromatic_aberration", "energy", "",
                  "largest relative error of a channel's light, of a blob of 2.5 px", channel_energy);

} // namespace
} // namespace postfx::host
