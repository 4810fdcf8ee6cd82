// Fog's metrics: 0 for what is exact, as much as it is off for what is spoiled, and little for the best levels.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

#include <cmath>

using postfx::ChainEntry;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("what comes through fog") {
    const FunctionMethod::Function exact =
        every_pixel([](const ChainEntry& entry, const MethodInput& input, double x, double y, double z) {
            const double tall = 2 * input.camera.tan_half_fov(), falloff = value_of(entry, "height_falloff");
            const double length = z * std::sqrt(1 + tall * tall * (x * x + y * y)), rise = z * tall * y;
            const double eye = input.camera.view_to_world[13], lower = eye + std::min(rise, 0.0);
            const double t = falloff * std::abs(rise);
            const double mean = t > 0 ? -std::expm1(-t) / t : 1;
            return std::exp(-value_of(entry, "density") * std::exp(-falloff * lower) * length * mean);
        });
    CHECK(measure("transmittance_error", FunctionMethod("fog", exact))
          < 1e-12); // roundings of heights up to 100 km
    CHECK(measure("transmittance_error", FunctionMethod("fog", spoiled(exact, 0.01)))
          == Approx(0.01).margin(1e-6));
    // Two uses of float32's exponential, and heights to the rounding of their distance.
    CHECK(measure("transmittance_error", EffectMethod("fog", "medium")) < 2e-5);
    CHECK(measure("transmittance_error", EffectMethod("fog", "classic")) > 0.1);
}
