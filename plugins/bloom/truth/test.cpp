// The truth of bloom against convolution term by term, and its parts against closed forms.
#include <catch2/catch.hpp>

#include "glow_kernel.hpp"

#include <truth_of.hpp>

#include <cmath>
#include <numbers>

using namespace postfx::host;
using postfx::Image64;

namespace {

constexpr int width = 24, height = 17;
constexpr double deviation = 3;

using Values = postfx::testing::Numbers;

TruthResult bloomed(const Image64& light, const Values& values) {
    return postfx::testing::truth_of("bloom", "scene", light, values, 2);
}

/// Light in some pixels, different in each channel.
Image64 some_light() {
    Image64 light(width, height, 3);
    for (std::size_t i = 0; i < light.values.size(); ++i)
        light.values[i] = i % 7 == 0 ? 0.01 * static_cast<double>(i % 101) : 0;
    light.at(5, 3, 1) = 20;
    light.at(width - 1, height - 2, 2) = 8;
    return light;
}

/// What the kernel puts x and y pixels away, from its definition: a Gaussian among pixels is e^-v I_n(v) on an axis.
class DirectKernel {
public:
    static constexpr int reach = 90;

    DirectKernel() : weights_(reach + 1, std::vector<double>(reach + 1)) {
        constexpr int widths = 400;
        for (int k = 0; k < widths; ++k) {
            const double t = (k + 0.5) / widths, v = 5 * deviation * deviation * std::pow(t, 4);
            std::vector<double> axis;
            for (int n = 0; n <= reach; ++n)
                axis.push_back(std::exp(-v) * std::cyl_bessel_i(n, v));
            for (std::size_t y = 0; y <= reach; ++y) {
                for (std::size_t x = 0; x <= reach; ++x)
                    weights_[y][x] += axis[x] * axis[y] / widths;
            }
        }
    }
    double at(int x, int y) const {
        return weights_[static_cast<std::size_t>(std::abs(y))][static_cast<std::size_t>(std::abs(x))];
    }

private:
    std::vector<std::vector<double>> weights_;
};

/// The picture goes on as its mirror image, which repeats the outermost pixel.
int mirrored(int i, int size) {
    const int period = 2 * size, inside = ((i % period) + period) % period;
    return inside < size ? inside : period - 1 - inside;
}

Image64 glow_term_by_term(const Image64& light) {
    static const DirectKernel kernel;
    Image64 glow(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int j = -DirectKernel::reach; j <= DirectKernel::reach; ++j) {
                for (int i = -DirectKernel::reach; i <= DirectKernel::reach; ++i) {
                    const double* from = light.pixel(mirrored(x + i, width), mirrored(y + j, height));
                    for (int c = 0; c < 3; ++c)
                        glow.at(x, y, c) += kernel.at(i, j) * from[c];
                }
            }
        }
    }
    return glow;
}

const Values glow_only = {{"intensity", 1}, {"radius", deviation / height}};

double largest_difference(const Image64& a, const Image64& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
    return largest;
}

/// Of the direct kernel's own quadrature: a midpoint rule, h^2 / 24 times the slope at the end.
constexpr double quadrature_error = 2e-6;

} // namespace

TEST_CASE("what the kernel leaves of a wave is the series of its integral") {
    for (const int nodes : {32, 64}) {
        const GlowKernel kernel(1, nodes);
        for (const double rate : {0.0, 0.01, 0.7, 3.0, 8.0}) { // of t^4 in the exponent; 5 times the loss
            double term = 1, series = 0;
            for (int k = 0; k < 80; ++k) {
                series += term / (4 * k + 1);
                term *= -rate / (k + 1);
            }
            CHECK(kernel.share_left(rate / 5) == Approx(series).epsilon(1e-12)); // terms reach 400
        }
        // The integral to infinity; what lies beyond 1 is below e^-rate.
        for (const double rate : {60.0, 1e3, 1e7})
            CHECK(kernel.share_left(rate / 5)
                  == Approx(std::tgamma(1.25) / std::pow(rate, 0.25)).epsilon(1e-11));
    }
}

TEST_CASE("the glow is the convolution, term by term") {
    const Image64 light = some_light();
    CHECK(largest_difference(bloomed(light, glow_only).picture, glow_term_by_term(light))
          < 20 * quadrature_error);
}

TEST_CASE("a point of light becomes the kernel") {
    Image64 point(81, 81, 3);
    point.at(40, 40, 0) = 1;
    // So far from the border that its mirror image counts for less than 1e-9.
    const TruthResult result = bloomed(point, {{"intensity", 1}, {"radius", 1.0 / 81}});
    double sum = 0, variance = 0;
    for (int y = 0; y < 81; ++y) {
        for (int x = 0; x < 81; ++x) {
            const double light = result.picture.at(x, y, 0);
            CHECK(light > -1e-15);
            sum += light;
            variance += light * (x - 40) * (x - 40);
        }
    }
    CHECK(sum == Approx(1).epsilon(1e-12));
    CHECK(variance == Approx(1).epsilon(1e-9)); // the deviation on an axis is 1 px
    CHECK(result.picture.at(40, 40, 1) == 0);
}

TEST_CASE("constant light stays, and light is neither lost nor made") {
    const TruthResult flat = bloomed(Image64(width, height, 3, 0.7), glow_only);
    CHECK(largest_difference(flat.picture, Image64(width, height, 3, 0.7)) < 1e-14);
    const Image64 light = some_light(), glow = bloomed(light, glow_only).picture;
    for (std::size_t c = 0; c < 3; ++c) {
        double before = 0, after = 0;
        for (std::size_t i = c; i < light.values.size(); i += 3) {
            before += light.values[i];
            after += glow.values[i];
        }
        CHECK(after == Approx(before).epsilon(1e-13));
    }
}

TEST_CASE("it knows its own error: that of the fewer nodes") {
    const double own_error = bloomed(some_light(), glow_only).own_error;
    CHECK(own_error < 1e-12);
    CHECK(own_error > 0);
}

TEST_CASE("intensity is the share that is scattered, the tint colours it") {
    const Image64 light = some_light(), glow = glow_term_by_term(light);
    Image64 expected = light;
    for (std::size_t i = 0; i < light.values.size(); ++i)
        expected.values[i] = 0.75 * light.values[i] + 0.25 * 0.5 * glow.values[i];
    const Image64 result =
        bloomed(light, {{"intensity", 0.25}, {"radius", deviation / height}, {"tint", 0.5}}).picture;
    CHECK(largest_difference(result, expected) < 20 * quadrature_error);
    CHECK(largest_difference(bloomed(light, {{"radius", 0}, {"tint", 0.5}}).picture, light) == 0);
}

TEST_CASE("a threshold passes what is above it, along a parabola") {
    // Constant light glows as itself: what passes is read off.
    const auto passed = [](double light) {
        const Values values = {{"mode", 1}, {"threshold", 2}, {"knee", 0.5}, {"intensity", 1}};
        return bloomed(Image64(8, 8, 3, light), values).picture.at(3, 3, 0) - light;
    };
    CHECK(passed(1) == Approx(0).margin(1e-13));
    CHECK(passed(2) == Approx(0.25).epsilon(1e-12)); // a quarter of the knee of 1
    CHECK(passed(1.5) == Approx(0.0625).epsilon(1e-12));
    CHECK(passed(3) == Approx(1).epsilon(1e-12));
    CHECK(passed(10) == Approx(8).epsilon(1e-12));
    CHECK(passed(65504) == 0); // there is no more room for light
}

TEST_CASE("a guarded pixel glows as its neighbours allow") {
    Image64 light(9, 9, 3, 1);
    light.at(4, 4, 0) = 1000;
    const Image64 free = bloomed(light, {{"intensity", 1}}).picture;
    const Image64 guarded = bloomed(light, {{"intensity", 1}, {"firefly_guard", 0.25}}).picture;
    double lost = 0;
    for (std::size_t i = 0; i < free.values.size(); i += 3)
        lost += free.values[i] - guarded.values[i];
    CHECK(lost == Approx(1000 - 4).epsilon(1e-12)); // 1 / 0.25 times the mean of eight neighbours of 1
}

TEST_CASE("what is no light does not spread") {
    Image64 light(9, 9, 3, 1);
    light.at(4, 4, 0) = -50;
    light.at(2, 2, 1) = std::nan("");
    const Image64 result = bloomed(light, {{"intensity", 0.5}, {"radius", 0.1}}).picture;
    CHECK(std::isnan(result.at(2, 2, 1)));
    CHECK(result.at(3, 2, 1) > 0.5);
    CHECK(result.at(4, 4, 0) > -25);
    CHECK(result.at(4, 5, 0) > 0.5);
}
