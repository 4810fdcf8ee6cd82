// Bloom's metrics on functions of which it is known what they have to find.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::ChainEntry;
using postfx::Image64;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("exact glow measures as exact, no glow as all of the light misplaced") {
    const FunctionMethod exact("bloom", [](const ChainEntry& entry, const MethodInput& input) {
        Numbers values;
        for (std::size_t i = 0; i < entry.values.size(); ++i)
            values[entry.effect->parameters[i].id] = entry.values[i][0];
        return truth_of("bloom", "scene", postfx::convert<double>(input.color), values, 2).picture;
    });
    CHECK(measure("psf_l1", exact) < 1e-11);
    CHECK(measure("dc_gain", exact) < 1e-13);
    const FunctionMethod none("bloom", unchanged);
    CHECK(measure("psf_l1", none) > 1.7); // 2, less twice the share that stays in the pixel
    CHECK(measure("psf_l1", none) < 2);
    CHECK(measure("dc_gain", none) == 0);
    const FunctionMethod dark("bloom",
                              [](const ChainEntry&, const MethodInput& input) { return dimmed(input, 2); });
    CHECK(measure("dc_gain", dark) == Approx(0.01).epsilon(1e-9));
}
