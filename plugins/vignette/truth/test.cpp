// Vignetting against what is known of its models.
#include <catch2/catch.hpp>

#include <truth_of.hpp>

#include <cmath>
#include <numbers>

using postfx::Image64;
using postfx::host::TruthResult;
using postfx::testing::Numbers;
using postfx::testing::truth_of;

namespace {

Image64 vignetted(int width, int height, double light, const Numbers& values) {
    const TruthResult result = truth_of("vignette", "scene", Image64(width, height, 3, light), values, 2);
    // A dozen roundings to float64 at most.
    CHECK(result.own_error < 12 * 0x1p-53);
    return result.picture;
}

/// Light from an even wall through a round hole onto a flat sensor 1 behind it, at `off` from the axis: the sum over
/// the hole's elements of both cosines over the squared distance.
double light_through_hole(double radius, double off) {
    constexpr int rings = 20, spokes = 40;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double r = radius * std::sqrt((i + 0.5) / rings);
        for (int j = 0; j < spokes; ++j) {
            const double angle = 2 * std::numbers::pi * (j + 0.5) / spokes;
            const double squared =
                1 + std::pow(off - r * std::cos(angle), 2) + std::pow(r * std::sin(angle), 2);
            sum += 1 / (squared * squared);
        }
    }
    return sum / (rings * spokes);
}

} // namespace

TEST_CASE("natural falloff is that of light through a small hole") {
    constexpr int width = 161, height = 91;
    const Image64 gain = vignetted(width, height, 1, {{"strength", 1}});
    const double tangent = std::tan(22.5 * std::numbers::pi / 180); // a scene's camera has 45 degrees
    CHECK(gain.at(80, 45, 0) == 1);
    for (const int x : {0, 17, 80, 160}) {
        for (const int y : {0, 30, 90}) {
            const double off = std::hypot(x - 80, y - 45) / (0.5 * height) * tangent;
            const double radius = 1e-4;
            // The hole's size shifts the ratio by its square.
            CHECK(gain.at(x, y, 1)
                  == Approx(light_through_hole(radius, off) / light_through_hole(radius, 0)).epsilon(1e-7));
        }
    }
}

TEST_CASE("a vignette takes its share of the darkening from the given picture") {
    const Image64 whole = vignetted(32, 18, 1, {{"strength", 1}});
    const Image64 part = vignetted(32, 18, 3, {{"strength", 0.25}});
    for (std::size_t i = 0; i < whole.values.size(); ++i)
        CHECK(part.values[i] == Approx(3 * (0.75 + 0.25 * whole.values[i])).epsilon(1e-14)); // roundings
}

TEST_CASE("an artistic vignette begins, ends and is half done where its values say") {
    // 100 pixels are one height; the row through the middle.
    const Numbers values = {{"model", 1}, {"strength", 0.8}, {"radius", 0.3}, {"softness", 0.5}};
    const Image64 gain = vignetted(201, 100, 1, values);
    const auto at = [&](double heights) {
        return gain.at(100 + static_cast<int>(std::lround(100 * heights)), 50, 0);
    };
    // The middle of row 50 is half a pixel from the centre: 0.005 heights, less than 1e-4 of these radii, and the
    // curve is 3 softnesses steep.
    CHECK(at(0.0) == 1);
    CHECK(at(0.29) == 1);
    CHECK(at(0.55) == Approx(1 - 0.8 / 2).margin(3e-4));
    CHECK(at(0.80) == Approx(0.2).margin(1e-4));
    CHECK(at(1.0) == Approx(0.2).margin(1e-15));

    Numbers oval = values;
    oval["roundness"] = 0;
    const Image64 wide = vignetted(202, 101, 1, oval);
    // An ellipse of the picture's shape: twice as far to the side as up.
    for (const int steps : {10, 20, 40})
        CHECK(wide.at(101 + 2 * steps, 50, 0) == Approx(wide.at(101, 50 + steps, 0)).margin(0.02));
    CHECK(wide.at(201, 50, 0) > vignetted(202, 101, 1, values).at(201, 50, 0) + 0.2);
}
