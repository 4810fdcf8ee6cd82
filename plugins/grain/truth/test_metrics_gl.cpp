// Grain's levels on inputs of which it is known what ought to come out: how good the best are, and that more
// costly ones are better.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::testing::EffectMethod;
using postfx::testing::measure;

TEST_CASE("grain comes nearer to film from level to level") {
    const double medium = measure("noise_distance", EffectMethod("grain", "medium"));
    CHECK(measure("noise_distance", EffectMethod("grain", "low")) > 1.5 * medium);
    CHECK(measure("noise_distance", EffectMethod("grain", "classic")) > 1.5 * medium);
    const double high = measure("noise_distance", EffectMethod("grain", "high"));
    CHECK(high < 0.5 * medium);
    CHECK(measure("noise_distance", EffectMethod("grain", "reference")) < 0.6 * high);
    // 24 patches of 128x128: 5 times sqrt(2 / 24 / 3000), a covariance taking 5 pixels.
    for (const char* level : {"low", "medium", "high"})
        CHECK(measure("variance", EffectMethod("grain", level)) < 0.027);
}
