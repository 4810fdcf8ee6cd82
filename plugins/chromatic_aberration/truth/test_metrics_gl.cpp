// Chromatic aberration's levels on inputs of which it is known what ought to come out: how good the best are, and that more
// costly ones are better.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::testing::EffectMethod;
using postfx::testing::measure;

TEST_CASE("chromatic aberration puts edges in their places") {
    // The step is linear within a pixel, and linear filtering keeps its light: what is left is float32's places.
    CHECK(measure("edge_position", EffectMethod("chromatic_aberration", "medium")) < 0.003);
    for (const char* level : {"high", "ultra", "reference"}) // they hold edges to their pixels
        CHECK(measure("edge_position", EffectMethod("chromatic_aberration", level)) < 0.05);
    CHECK(measure("edge_position", EffectMethod("chromatic_aberration", "classic")) > 0.3);
    CHECK(measure("energy", EffectMethod("chromatic_aberration", "medium")) < 1e-3);
    CHECK(measure("energy", EffectMethod("chromatic_aberration", "reference")) < 3e-3); // it cuts tips
}
