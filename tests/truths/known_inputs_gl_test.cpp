// The effects' levels on inputs of which it is known what ought to come out: how good the best are, and that more
// costly ones are better.
#include "effect_method.hpp"

#include <catch2/catch.hpp>

using postfx::testing::EffectMethod;

namespace {

double measured(const std::string& effect, const std::string& metric, const std::string& level) {
    return postfx::testing::measure(metric, EffectMethod(effect, level));
}

} // namespace

TEST_CASE("bloom's levels approach the exact glow and keep constant light") {
    double before = 2;
    for (const char* level : {"low", "medium", "high", "ultra", "reference"}) {
        INFO(level);
        const double error = measured("bloom", "psf_l1", level);
        CHECK(error < 0.75 * before);
        CHECK(measured("bloom", "dc_gain", level) < 1e-6); // rounding of a handful of sums
        before = error;
    }
    CHECK(before < 0.02); // of 256 rows; what is left is the point itself
    CHECK(measured("bloom", "psf_l1", "classic") > 1);
}

TEST_CASE("chromatic aberration puts edges in their places") {
    // The step is linear within a pixel, and linear filtering keeps its light: what is left is float32's places.
    CHECK(measured("chromatic_aberration", "edge_position", "medium") < 0.003);
    for (const char* level : {"high", "ultra", "reference"}) // they hold edges to their pixels
        CHECK(measured("chromatic_aberration", "edge_position", level) < 0.05);
    CHECK(measured("chromatic_aberration", "edge_position", "classic") > 0.3);
    CHECK(measured("chromatic_aberration", "energy", "medium") < 1e-3);
    CHECK(measured("chromatic_aberration", "energy", "reference") < 3e-3); // it cuts tips
}

TEST_CASE("grain comes nearer to film from level to level") {
    const double medium = measured("grain", "noise_distance", "medium");
    CHECK(measured("grain", "noise_distance", "low") > 1.5 * medium);
    CHECK(measured("grain", "noise_distance", "classic") > 1.5 * medium);
    const double high = measured("grain", "noise_distance", "high");
    CHECK(high < 0.5 * medium);
    CHECK(measured("grain", "noise_distance", "reference") < 0.6 * high);
    // 24 patches of 128x128: 5 times sqrt(2 / 24 / 3000), a covariance taking 5 pixels.
    for (const char* level : {"low", "medium", "high"})
        CHECK(measured("grain", "variance", level) < 0.027);
}

TEST_CASE("depth of field keeps a point's light and leaks none over an edge") {
    for (const char* level : {"low", "medium", "ultra"}) {
        INFO(level);
        CHECK(measured("depth_of_field", "energy", level) < 1e-4); // float32 sums of some hundred taps
        CHECK(measured("depth_of_field", "leakage", level) < 1e-4);
    }
    CHECK(measured("depth_of_field", "leakage", "classic") > 0.05);
}
