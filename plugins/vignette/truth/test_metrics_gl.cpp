// Vignette's metrics: 0 for what is exact, as much as it is off for what is spoiled, and little for the best levels.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

#include <cmath>

using postfx::ChainEntry;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("a vignette's gain") {
    const FunctionMethod::Function exact =
        every_pixel([](const ChainEntry&, const MethodInput& input, double x, double y, double) {
            return std::pow(std::cos(std::atan(2 * input.camera.tan_half_fov() * std::hypot(x, y))), 4);
        });
    CHECK(measure("gain_error", FunctionMethod("vignette", exact)) < 1e-14);
    CHECK(measure("gain_error", FunctionMethod("vignette", spoiled(exact, 0.02))) == Approx(0.02));
    CHECK(measure("gain_error", EffectMethod("vignette", "medium")) < 4 * 0x1p-23);
    CHECK(measure("gain_error", EffectMethod("vignette", "classic")) > 0.1);
}
