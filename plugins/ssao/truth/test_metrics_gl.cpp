// Occlusion's metrics: 0 for what is exact, as much as it is off for what is spoiled, and little for the best levels.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

#include <cmath>
#include <numbers>

using postfx::ChainEntry;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("a wall's and a plane's occlusion") {
    const FunctionMethod::Function open = every_pixel([](auto&&...) { return 1.0; });
    CHECK(measure("plane_error", FunctionMethod("ssao", open)) == 0);
    CHECK(measure("plane_error", FunctionMethod("ssao", spoiled(open, 0.03))) == Approx(0.03));

    // The fold is 5 m away and both sides rise at 45 degrees.
    const FunctionMethod::Function wall =
        every_pixel([](const ChainEntry& entry, const MethodInput&, double, double, double z) {
            const double k = std::min((5 - z) * std::sqrt(2.0) / value_of(entry, "radius"), 1.0);
            return 1 - (std::acos(k) - k * std::sqrt(1 - k * k)) / std::numbers::pi;
        });
    CHECK(measure("wall_error", FunctionMethod("ssao", wall))
          < 1e-4); // the root at the foot of depths in float32
    CHECK(measure("wall_error", FunctionMethod("ssao", spoiled(wall, 0.05))) == Approx(0.05).margin(1e-4));
    CHECK(measure("wall_error", FunctionMethod("ssao", open)) > 0.1);

    const double best = measure("wall_error", EffectMethod("ssao", "reference"));
    CHECK(best < 0.02); // its 64 samples per side leave gaps
    CHECK(best < measure("wall_error", EffectMethod("ssao", "medium")));
    CHECK(measure("plane_error", EffectMethod("ssao", "medium")) <= 1.0 / 255);
    CHECK(measure("plane_error", EffectMethod("ssao", "classic")) > 0.1);
}
