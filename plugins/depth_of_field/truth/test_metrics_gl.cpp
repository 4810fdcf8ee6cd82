// Depth of field's levels on inputs of which it is known what ought to come out: how good the best are, and that more
// costly ones are better.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::testing::EffectMethod;
using postfx::testing::measure;

TEST_CASE("depth of field keeps a point's light and leaks none over an edge") {
    for (const char* level : {"low", "medium", "ultra"}) {
        INFO(level);
        CHECK(measure("energy", EffectMethod("depth_of_field", level))
              < 1e-4); // float32 sums of some hundred taps
        CHECK(measure("leakage", EffectMethod("depth_of_field", level)) < 1e-4);
    }
    CHECK(measure("leakage", EffectMethod("depth_of_field", "classic")) > 0.05);
}
