// Quadrature of fog against integrals that are known.
#include <catch2/catch.hpp>

#include "fog_path.hpp"

#include <cmath>

using namespace postfx::host;

namespace {

/// From the lower end up, so that nothing overflows that is not opaque.
double thickness(const FogPath& path) {
    const double lowest = path.height + std::min(path.rise * path.length, 0.0);
    const double densest = path.density * std::exp(-path.falloff * lowest);
    const double per_metre = path.falloff * std::abs(path.rise);
    return per_metre == 0 ? densest * path.length
                          : -densest * std::expm1(-per_metre * path.length) / per_metre;
}

void check_both(const FogPath& path, double expected) {
    INFO("density " << path.density << ", falloff " << path.falloff << ", height " << path.height << ", rise "
                    << path.rise << ", length " << path.length);
    // Roundings of a thickness, of which no more than e^-1 comes through.
    CHECK(fog_by_thickness(path).transmittance == Approx(std::exp(-expected)).margin(1e-13));
    CHECK(fog_by_thickness(path).opacity == Approx(-std::expm1(-expected)).margin(1e-13));
    // Some hundred steps of 1e-13 each.
    CHECK(fog_by_transfer(path).transmittance == Approx(std::exp(-expected)).margin(3e-11));
    CHECK(fog_by_transfer(path).opacity == Approx(-std::expm1(-expected)).margin(3e-11));
}

} // namespace

TEST_CASE("even fog lets through e to the minus density times length") {
    for (const double length : {1e-6, 1.0, 40.0, 1e4, 1e20})
        check_both({.density = 0.02, .length = length}, 0.02 * length);
}

TEST_CASE("fog that thins out with height is the integral that is known") {
    for (const double falloff : {1e-8, 0.04, 1.0, 10.0}) {
        for (const double rise : {-1.0, -0.3, -1e-5, 0.0, 1e-9, 0.02, 0.7, 1.0}) {
            for (const double height : {-10.0, 0.0, 3.0, 200.0}) {
                for (const double length : {0.05, 7.0, 300.0, 20000.0}) {
                    const FogPath path{.density = 0.02,
                                       .falloff = falloff,
                                       .height = height,
                                       .rise = rise,
                                       .length = length};
                    check_both(path, thickness(path));
                }
            }
        }
    }
}

TEST_CASE("upwards to the sky there is as much fog as lies over the eye") {
    for (const double rise : {1.0, 0.1, 1e-4}) {
        check_both({.density = 0.02, .falloff = 0.04, .height = 30, .rise = rise, .length = 1e20},
                   0.02 * std::exp(-0.04 * 30) / (0.04 * rise));
        check_both({.density = 0.02, .falloff = 0.04, .height = 30, .rise = -rise, .length = 1e20}, 1e9);
    }
}

TEST_CASE("no fog, and fog that no number holds") {
    check_both({.density = 0, .falloff = 1, .height = 3, .rise = 1, .length = 1e20}, 0);
    check_both({.density = 0.02, .falloff = 0.04, .length = 0}, 0);
    check_both({.density = 1, .falloff = 10, .height = -1e5, .rise = 0.5, .length = 10}, 1e9);
}
