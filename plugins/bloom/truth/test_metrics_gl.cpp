// Bloom's levels on inputs of which it is known what ought to come out: how good the best are, and that more
// costly ones are better.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::testing::EffectMethod;
using postfx::testing::measure;

TEST_CASE("bloom's levels approach the exact glow and keep constant light") {
    double before = 2;
    for (const char* level : {"low", "medium", "high", "ultra", "reference"}) {
        INFO(level);
        const double error = measure("psf_l1", EffectMethod("bloom", level));
        CHECK(error < 0.75 * before);
        CHECK(measure("dc_gain", EffectMethod("bloom", level)) < 1e-6); // rounding of a handful of sums
        before = error;
    }
    CHECK(before < 0.02); // of 256 rows; what is left is the point itself
    CHECK(measure("psf_l1", EffectMethod("bloom", "classic")) > 1);
}
