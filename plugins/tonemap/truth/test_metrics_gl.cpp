// Tone curves' metrics: 0 for what is exact, as much as it is off for what is spoiled, and little for the best levels.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::ChainEntry;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("tone curves") {
    // The curves' points are in the truth's test; here it is enough that the effect has them.
    const FunctionMethod::Function run = [](const ChainEntry& entry, const MethodInput& input) {
        Values values;
        for (std::size_t i = 0; i < entry.values.size(); ++i)
            values[entry.effect->parameters[i].id] = entry.values[i][0];
        return postfx::convert<double>(three_channels(run_effect("tonemap", {.color = input.color}, values)));
    };
    CHECK(measure("curve_error", FunctionMethod("tonemap", run)) < 16 * 0x1p-23);
    CHECK(measure("curve_error", FunctionMethod("tonemap", spoiled(run, 0.01))) == Approx(0.01).margin(1e-5));
}
