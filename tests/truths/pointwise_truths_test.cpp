// Truths of effects that look at one pixel only, against what is known of their models.
#include "given_truth.hpp"

#include <cmath>
#include <numbers>

using postfx::Image64;
using postfx::host::TruthResult;
using postfx::testing::truth_of;
using Values = std::map<std::string, double>;

namespace {

Image64 vignetted(int width, int height, double light, const Values& values) {
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

double mapped(double light, const Values& values) {
    return truth_of("tonemap", "layer", Image64(2, 1, 3, light), values, 2).picture.values[0];
}

enum Operator { aces, reinhard, hable, clamped };

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
    const Values values = {{"model", 1}, {"strength", 0.8}, {"radius", 0.3}, {"softness", 0.5}};
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

    Values oval = values;
    oval["roundness"] = 0;
    const Image64 wide = vignetted(202, 101, 1, oval);
    // An ellipse of the picture's shape: twice as far to the side as up.
    for (const int steps : {10, 20, 40})
        CHECK(wide.at(101 + 2 * steps, 50, 0) == Approx(wide.at(101, 50 + steps, 0)).margin(0.02));
    CHECK(wide.at(201, 50, 0) > vignetted(202, 101, 1, values).at(201, 50, 0) + 0.2);
}

TEST_CASE("tone curves pass the points that they are made for") {
    for (const Operator curve : {aces, reinhard, hable, clamped}) {
        const Values values = {{"operator", curve}, {"white", 3}};
        CHECK(mapped(0, values) == 0);
        CHECK(mapped(-1, values) == 0);
        double before = 0;
        for (double light = 1e-4; light < 1e5; light *= 1.5) {
            const double now = mapped(light, values);
            CHECK(now >= before);
            CHECK(now <= 1);
            before = now;
        }
        CHECK(before > 0.99);
        Values brighter = values;
        brighter["exposure"] = 2;
        CHECK(mapped(0.05, brighter) == Approx(mapped(0.2, values)).epsilon(1e-14)); // roundings
    }
    // Reinhard's white comes out as 1, middle grey by the published curve.
    CHECK(mapped(3, {{"operator", reinhard}, {"white", 3}}) == Approx(1).margin(1e-14));
    CHECK(mapped(0.18, {{"operator", reinhard}, {"white", 1000}}) == Approx(0.18 / 1.18).epsilon(1e-6));
    CHECK(mapped(11.2 / 2, {{"operator", hable}}) == Approx(1).margin(1e-14)); // after its bias of 2
    CHECK(mapped(0.18, {{"operator", aces}}) == Approx(0.21).margin(0.005));
    CHECK(mapped(0.7, {{"operator", clamped}}) == 0.7);
}

TEST_CASE("reinhard's curve keeps hue and luminance, also where a channel does not fit") {
    const auto luminance = [](const double* c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
    Image64 light(3, 1, 3);
    light.values = {0.4, 0.2, 0.1, 0.1, 0.2, 8, 30, 1, 1};
    const TruthResult result = truth_of("tonemap", "layer", light, {{"operator", reinhard}, {"white", 4}}, 2);
    CHECK(result.own_error < 12 * 0x1p-53);
    for (int x = 0; x < 3; ++x) {
        const double before = luminance(light.pixel(x, 0));
        const double after = std::min(before * (1 + before / 16) / (1 + before), 1.0);
        CHECK(luminance(result.picture.pixel(x, 0)) == Approx(after).epsilon(1e-13)); // roundings
    }
    CHECK(result.picture.at(0, 0, 0) / result.picture.at(0, 0, 2) == Approx(4).epsilon(1e-13));
    CHECK(result.picture.at(1, 0, 2) == Approx(1).margin(1e-15));
}
