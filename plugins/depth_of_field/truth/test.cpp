// What one layer of colour and depth shows through a lens, against closed forms.
#include <catch2/catch.hpp>

#include "layer_lens.hpp"

#include <truths/sampling.hpp>

#include <cmath>
#include <numbers>

using namespace postfx::host;
using postfx::Image64;

namespace {

constexpr int size = 48, points = 1024;

/// Focused at 2 m; c = 24 px (1 - 2 / z) in a picture 48 pixels high.
ThinLens lens() {
    return {.aperture = 1, .focus = {0.5, 0.5, 0.5}, .half_extent = glm::dvec2(0.5)};
}

Image64 seen(const Image64& color, const std::vector<double>& inverse_distance,
             const ThinLens& through = lens()) {
    LayerLens layer(color, inverse_distance, through);
    Image64 sum(color.width, color.height, LayerLens::channels);
    for (int i = 0; i < points; ++i)
        layer.add(lens_point(i), sum);
    return layer.picture(sum);
}

std::vector<double> flat(double distance) {
    return std::vector<double>(size * size, 1 / distance);
}

double largest_difference(const Image64& a, const Image64& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
    return largest;
}

/// Left of column 24 one surface, right of it another.
Image64 half_and_half(double left, double right) {
    Image64 image(size, size, 3);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = i / 3 % size < size / 2 ? left : right;
    return image;
}

std::vector<double> half_and_half_at(double left, double right) {
    std::vector<double> inverse_distance(size * size);
    for (std::size_t i = 0; i < inverse_distance.size(); ++i)
        inverse_distance[i] = 1 / (i % size < size / 2 ? left : right);
    return inverse_distance;
}

/// Share of a disc on the near side of a line at `t` radii from its middle.
double disc_share(double t) {
    if (std::abs(t) >= 1) return t > 0;
    return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
}

// Sums of 1024 areas in float64, each a product of differences of numbers near 48.
constexpr double rounding = 1e-12;

} // namespace

TEST_CASE("a constant picture stays, whatever its depth") {
    std::vector<double> inverse_distance(size * size);
    for (std::size_t i = 0; i < inverse_distance.size(); ++i)
        inverse_distance[i] = 2 * sobol_point(static_cast<std::uint32_t>(i), 5).x;
    const Image64 color(size, size, 3, 0.75);
    CHECK(largest_difference(seen(color, inverse_distance), color) < rounding);
}

TEST_CASE("a picture in focus stays") {
    Image64 color(size, size, 3);
    for (std::size_t i = 0; i < color.values.size(); ++i)
        color.values[i] = sobol_point(static_cast<std::uint32_t>(i), 9).y;
    CHECK(largest_difference(seen(color, flat(2)), color) < rounding);
}

TEST_CASE("a point out of focus is a disc of the lens' diameter that keeps its light") {
    for (const double distance : {1.4, 4.0}) {
        Image64 color(size, size, 3);
        color.at(24, 24, 1) = 1;
        const Image64 result = seen(color, flat(distance));
        double light = 0, spread = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                light += result.at(x, y, 1);
                spread += result.at(x, y, 1) * ((x - 24) * (x - 24) + (y - 24) * (y - 24));
            }
        }
        const double diameter = 24 * std::abs(1 - 2 / distance);
        // A disc of diameter c has the second moment c^2 / 8; the pixel's own box, and the pixels that it falls in,
        // have 1/6 each.
        INFO(distance);
        CHECK(light == Approx(1).margin(1e-9));
        CHECK(std::sqrt(8 * (spread / light - 2.0 / 6)) == Approx(diameter).margin(0.05));
    }
}

TEST_CASE("a sharp edge before a blurred plane stays a step") {
    const Image64 color = half_and_half(1, 0.25);
    const Image64 result = seen(color, half_and_half_at(2, 8));
    CHECK(largest_difference(result, color) < rounding);
}

TEST_CASE("a blurred edge before a sharp plane covers as a disc does") {
    const Image64 result = seen(half_and_half(1, 0), half_and_half_at(1.25, 2));
    const double radius = 24 * (2 / 1.25 - 1) / 2;
    // On both sides: what the near surface hid is taken to be as what is beside it. 1024 points in 14 columns; within
    // a column the share is straight to 0.002.
    for (int x = 8; x < size - 8; ++x) {
        INFO(x);
        CHECK(result.at(x, size / 2, 0) == Approx(disc_share((24 - x - 0.5) / radius)).margin(0.006));
    }
}

TEST_CASE("colours have their own focus") {
    ThinLens colored = lens();
    colored.focus = {0.5, 0.25, 0.5};
    Image64 color(size, size, 3);
    color.at(24, 24, 0) = color.at(24, 24, 1) = 1;
    const Image64 result = seen(color, flat(4), colored);
    CHECK(result.at(24, 24, 0) < 0.02);
    CHECK(result.at(24, 24, 1) == Approx(1).margin(rounding));
}
