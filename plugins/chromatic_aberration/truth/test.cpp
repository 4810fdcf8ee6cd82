// The truth of lateral chromatic aberration on pictures of which it is known what a lens makes of them.
#include <catch2/catch.hpp>

#include "lens_spectrum.hpp"
#include "spline_picture.hpp"

#include <truth_of.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

using namespace postfx::host;
using postfx::Image64;

namespace {

constexpr int width = 160, height = 90;
constexpr double strength = 0.05; // 4.5 px from red to blue in the corner

TruthResult aberrated(const Image64& light, int samples) {
    return postfx::testing::truth_of("chromatic_aberration", "layer", light, {{"strength", strength}},
                                     samples);
}

/// Of the offset from the centre [px], the same in all channels.
Image64 painted(const std::function<double(double, double)>& light) {
    Image64 image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            std::fill_n(image.pixel(x, y), 3, light(x + 0.5 - width / 2.0, y + 0.5 - height / 2.0));
    }
    return image;
}

/// Where the ends of the spectrum lie, as shares of their distance from each other, by Cauchy's formula.
const double red_end =
    (std::pow(0.612, -2) - std::pow(0.549, -2)) / (std::pow(0.464, -2) - std::pow(0.612, -2));
const double whole = strength * height / (0.5 * std::hypot(width, height));

/// Integral of a channel's kernel times f(magnification - 1), on either side of green by many steps.
double over_kernel(int channel, const std::function<double(double)>& f) {
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps, red = f(whole * red_end * t), blue = f(whole * (1 + red_end) * t);
        sum += channel == 0 ? 2 * t * red : channel == 2 ? 2 * t * blue : (1 - t) * (red + blue);
    }
    return sum / steps;
}

} // namespace

TEST_CASE("the spectrum's quantiles are the kernels'") {
    const LensSpectrum spectrum(strength, width, height);
    CHECK(spectrum.red_end() == Approx(whole * red_end).epsilon(1e-14));
    CHECK(spectrum.blue_end() - spectrum.red_end() == Approx(whole).epsilon(1e-14));
    for (int channel = 0; channel < 3; ++channel) {
        for (const auto& f : {std::function([](double d) { return d; }),
                              std::function([](double d) { return std::cos(300 * d); })}) {
            constexpr int steps = 20000;
            double sum = 0;
            for (int i = 0; i < steps; ++i)
                sum += f(spectrum.displacement(channel, (i + 0.5) / steps)) / steps;
            CHECK(sum
                  == Approx(over_kernel(channel, f)).margin(1e-5)); // roots at the kernels' ends: steps^-1.5
        }
    }
}

TEST_CASE("the spline keeps pixels and constants, and draws waves and parabolas between pixels") {
    const auto wave = [](double x) { return std::cos(2 * std::numbers::pi * x / 6); };
    Image64 image(64, 8, 3);
    for (int x = 0; x < 64; ++x) {
        for (int y = 0; y < 8; ++y) {
            image.at(x, y, 0) = 0.3;
            image.at(x, y, 1) = wave(x + 0.5);
            image.at(x, y, 2) = std::pow((x + 0.5) / 10 - 2.5, 5);
        }
    }
    const SplinePicture picture(image);
    for (double x = 20; x < 30; x += 0.1) {
        CHECK(picture.at(x, 3.3, 0) == Approx(0.3).epsilon(1e-14));
        // What the picture's ends do to the spline is 0.43^20 of them, which are 600.
        CHECK(picture.at(x, 4.5, 2) == Approx(std::pow(x / 10 - 2.5, 5)).margin(1e-4));
        CHECK(picture.at(x, 4.5, 1) == Approx(wave(x)).margin(5e-4)); // the spline's own error at 6 px
    }
    CHECK(picture.at(22.5, 4.5, 1) == Approx(wave(22.5)).margin(1e-12));
    // A lamp of a pixel does not darken what is around it.
    Image64 lamp(16, 16, 3);
    lamp.at(8, 8, 0) = 100;
    const SplinePicture lit(lamp);
    CHECK(lit.at(9.9, 8.5, 0) < -1);
    CHECK(lit.within_neighbours(9.9, 8.5, 0) == 0);
    CHECK(lit.within_neighbours(9, 8.5, 0) == lit.at(9, 8.5, 0));
    CHECK(picture.at(-5, -5, 0) == Approx(0.3).epsilon(1e-14)); // the edge goes on
}

TEST_CASE("a constant stays, a ramp is displaced by its channel's mean") {
    const Image64 flat(width, height, 3, 3.5);
    for (const double value : aberrated(flat, 16).picture.values)
        REQUIRE(value == Approx(3.5).epsilon(1e-13));
    const Image64 result = aberrated(painted([](double x, double) { return x; }), 256).picture;
    for (int channel = 0; channel < 3; ++channel) {
        const double slope = over_kernel(channel, [](double d) { return 1 + d; });
        for (int x = 20; x < width - 20; x += 7) {
            const double offset = x + 0.5 - width / 2.0;
            // 256 wavelengths: evenly spread, 256^-1.5 of the largest displacement.
            CHECK(result.at(x, 40, channel) == Approx(slope * offset).margin(1e-3));
        }
    }
}

TEST_CASE("an edge becomes its channel's kernel, summed up") {
    const double edge = 61.25;
    const auto step = [&](double x) { return 0.5 * std::erfc((x - edge) / 2); };
    const Image64 result = aberrated(painted([&](double x, double) { return step(x); }), 512).picture;
    for (int channel = 0; channel < 3; ++channel) {
        double reach = 0, worst = 0;
        for (int x = 0; x < width; ++x) {
            const double offset = x + 0.5 - width / 2.0, light = result.at(x, 30, channel);
            reach += light;
            const double expected = over_kernel(channel, [&](double d) { return step(offset * (1 + d)); });
            worst = std::max(worst, std::abs(light - expected));
        }
        const double place = width / 2.0 + edge * over_kernel(channel, [](double d) { return 1 / (1 + d); });
        INFO("channel " << channel);
        CHECK(reach == Approx(place).margin(0.002));
        CHECK(worst < 0.08); // a spline rings at an edge of one pixel
    }
}

TEST_CASE("a blob keeps its light up to magnification") {
    const Image64 blob = painted([](double x, double y) {
        return std::exp(-(std::pow(x - 50.3, 2) + std::pow(y + 20.1, 2)) / (2 * 2.5 * 2.5));
    });
    const Image64 result = aberrated(blob, 256).picture;
    std::array<double, 3> sums{};
    for (std::size_t i = 0; i < result.values.size(); ++i)
        sums[i % 3] += result.values[i];
    const double light = 2 * std::numbers::pi * 2.5 * 2.5;
    for (int channel = 0; channel < 3; ++channel) {
        const double expected = light * over_kernel(channel, [](double d) { return std::pow(1 + d, -2); });
        CHECK(sums[static_cast<std::size_t>(channel)]
              == Approx(expected).epsilon(2e-3)); // the blob's tip is held to its pixels
    }
}

TEST_CASE("own error is what more wavelengths change") {
    const Image64 rings =
        painted([](double x, double y) { return 1 + std::cos(2 * std::numbers::pi * std::hypot(x, y) / 7); });
    const TruthResult few = aberrated(rings, 32), many = aberrated(rings, 1024);
    double sum = 0;
    for (std::size_t i = 0; i < many.picture.values.size(); ++i)
        sum += std::pow(few.picture.values[i] - many.picture.values[i], 2);
    const double error =
        std::sqrt(sum / static_cast<double>(many.picture.values.size())) / many.root_mean_square;
    CHECK(few.own_error == Approx(error).epsilon(0.1));
    CHECK(many.own_error < few.own_error / 32); // evenly spread wavelengths: faster than their number
    CHECK(many.own_error < 1e-4);
}

TEST_CASE("no number counts as black, and does not spread as such") {
    Image64 light(32, 32, 3, 1);
    light.at(20, 20, 0) = std::nan("");
    for (const double value : aberrated(light, 8).picture.values)
        REQUIRE(std::isfinite(value));
}
