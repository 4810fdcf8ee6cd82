// Against the truth that one layer of colour and depth holds: every pixel is thrown where each point of a lens sees
// it, the nearest wins. It shares nothing with the effect but the circles, which have a closed form of their own.
#include "test_scenes.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr int width = 200, height = 200;
constexpr double at_infinity = 20; ///< circle, pixels

/// A scene given by the circle of each pixel [px].
struct Layered {
    Image color;
    std::function<double(int, int)> circle;

    Input input() const {
        return scene(color, [this](int x, int y) { return distance_with(circle(x, y) / at_infinity); });
    }
};

double wave(double x, double y) {
    return 1 + 0.4 * std::sin(0.7 * x) * std::cos(0.45 * y);
}

/// A near bar, a slope from before the focus to behind it, something bright in focus, a background with lights.
Layered still_life() {
    const auto circle = [](int x, int y) {
        if (x > 40 && x < 65) return -17.0;
        if (y < 60) return -10.0 + 0.3 * y;
        return std::hypot(x - 130, y - 110) < 35 ? 0.0 : 18.0;
    };
    const auto light = [circle](int x, int y) {
        const double c = circle(x, y);
        if (c == 18.0 && x % 43 < 3 && y % 32 < 3) return 30.0;
        return wave(x, y) * (c == 0.0 ? 8 : c == -17.0 ? 0.2 : 1);
    };
    return {painted(width, height, light), circle};
}

/// What is seen from the point (px, py) of the lens.
std::vector<double> seen_from(const Layered& scene, double px, double py) {
    constexpr int border = 12;
    constexpr double nothing = 1e9;
    std::vector<double> circles(std::size_t{width} * height, nothing), light(circles.size());
    const auto index = [](int x, int y) {
        return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
    };
    for (int y = -border; y < height + border; ++y) {
        for (int x = -border; x < width + border; ++x) {
            const int inner_x = std::clamp(x, 0, width - 1), inner_y = std::clamp(y, 0, height - 1);
            const double c = scene.circle(inner_x, inner_y);
            const int to_x = x + static_cast<int>(std::lround(c / 2 * px));
            const int to_y = y + static_cast<int>(std::lround(c / 2 * py));
            if (to_x < 0 || to_y < 0 || to_x >= width || to_y >= height) continue;
            if (c >= circles[index(to_x, to_y)]) continue;
            circles[index(to_x, to_y)] = c;
            light[index(to_x, to_y)] = scene.color.at(inner_x, inner_y, 0);
        }
    }
    // What no pixel reached is hidden in the picture: the deeper of the two sides goes on.
    std::vector<double> result = light;
    const double longer = std::max(std::abs(px), std::abs(py));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (circles[index(x, y)] != nothing) continue;
            double deepest = -nothing;
            for (double side : {-1.0, 1.0}) {
                for (int step = 1; step <= 2 * border; ++step) {
                    const int u = x + static_cast<int>(std::lround(side * step * px / longer));
                    const int v = y + static_cast<int>(std::lround(side * step * py / longer));
                    if (u < 0 || v < 0 || u >= width || v >= height) break;
                    const double c = circles[index(u, v)];
                    if (c == nothing) continue;
                    if (c > deepest) deepest = c, result[index(x, y)] = light[index(u, v)];
                    break;
                }
            }
        }
    }
    return result;
}

Image64 truth(const Layered& scene) {
    constexpr int rings = 16; // 768 points, each for the same area of the lens
    Image64 sum(width, height, 3);
    int count = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const int points = 6 * ring + 3;
        for (int i = 0; i < points; ++i, ++count) {
            const double radius = (ring + 0.5) / rings,
                         angle = 2 * std::numbers::pi * (i + 0.5 * (ring % 2)) / points;
            const auto light = seen_from(scene, radius * std::cos(angle), radius * std::sin(angle));
            for (std::size_t p = 0; p < light.size(); ++p) {
                for (std::size_t c = 0; c < 3; ++c)
                    sum.values[3 * p + c] += light[p];
            }
        }
    }
    for (double& value : sum.values)
        value /= count;
    return sum;
}

double root_mean_square(const Image& image, const Image64& expected) {
    double sum = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            sum += std::pow(image.at(x, y, 0) - expected.at(x, y, 0), 2);
    }
    return std::sqrt(sum / (width * height));
}

} // namespace

TEST_CASE("each level is nearer the truth than the one below, and classic is far from it") {
    const Layered layered = still_life();
    const Image64 expected = truth(layered);
    std::map<int, double> error;
    for (int level : {low, medium, ultra, reference_level, classic}) {
        error[level] = root_mean_square(
            run_effect("depth_of_field", layered.input(), lens(at_infinity, height, perspective, level)),
            expected);
        fmt::print("root mean square error of {:9}: {:.4f}\n", level_names[level], error[level]);
    }
    CHECK(error[medium] <= error[low]);
    CHECK(error[ultra] <= error[medium]);
    CHECK(error[reference_level] <= error[ultra]);
    CHECK(6 * error[medium] <= error[classic]);
}
