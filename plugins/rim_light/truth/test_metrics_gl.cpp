// Rim light's metrics: 0 for what is exact, as much as it is off for what is spoiled, and little for the best levels.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

#include <cmath>

using postfx::ChainEntry;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("a sphere's rim") {
    // The sphere's centre is 3 m away.
    const FunctionMethod::Function exact =
        every_pixel([](const ChainEntry& entry, const MethodInput& input, double x, double y, double) {
            const double cosine = std::sqrt(1 - std::pow(input.camera.vertical_extent, 2) * (x * x + y * y));
            if (std::isnan(cosine)) return 0.0;
            if (value_of(entry, "profile") == 0) return std::max(1 - cosine / value_of(entry, "width"), 0.0);
            const double in = std::acos(cosine), out = std::asin(std::sin(in) / 1.5);
            return (std::pow(std::sin(in - out) / std::sin(in + out), 2)
                    + std::pow(std::tan(in - out) / std::tan(in + out), 2))
                   / 2;
        });
    CHECK(measure("sphere_error", FunctionMethod("rim_light", exact)) < 1e-12);
    CHECK(measure("sphere_error", FunctionMethod("rim_light", spoiled(exact, 0.02))) == Approx(0.02));
    CHECK(measure("sphere_error", EffectMethod("rim_light", "medium")) < 1e-5);
    // 750 pixels on the circle, each 0.3 off at random.
    CHECK(measure("mean_error", FunctionMethod("rim_light", exact)) < 1e-3);
    CHECK(measure("mean_error", FunctionMethod("rim_light", spoiled(exact, 0.02))) > 0.015);
    CHECK(measure("mean_error", EffectMethod("rim_light", "medium")) < 1e-3);
}
