// Chromatic aberration's metrics on functions of which it is known what they have to find.
#include <catch2/catch.hpp>

#include "lens_spectrum.hpp"
#include "spline_picture.hpp"

#include <effect_method.hpp>

using postfx::ChainEntry;
using postfx::Image64;
using postfx::host::MethodInput;
using namespace postfx::testing;

TEST_CASE("a lens that shows waves as they are has its edges in their places") {
    const FunctionMethod exact("chromatic_aberration", [](const ChainEntry& entry, const MethodInput& input) {
        const int width = input.color.width, height = input.color.height;
        const postfx::host::LensSpectrum spectrum(value_of(entry, "strength"), width, height);
        const postfx::host::SplinePicture picture(postfx::convert<double>(input.color));
        constexpr int wavelengths = 12;
        Image64 result(width, height, 3);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    for (int i = 0; i < wavelengths; ++i) {
                        const double scale = 1 + spectrum.displacement(c, (i + 0.5) / wavelengths);
                        result.at(x, y, c) += picture.at(width / 2.0 + (x + 0.5 - width / 2.0) * scale,
                                                         height / 2.0 + (y + 0.5 - height / 2.0) * scale, c)
                                              / wavelengths;
                    }
                }
            }
        }
        return result;
    });
    // 12 wavelengths take a kernel's root for a staircase: 12^-1.5 / 4 of blue's 2 pixels at most.
    CHECK(measure("edge_position", exact) < 0.01);
    CHECK(measure("energy", exact) < 1e-4);
    const FunctionMethod none("chromatic_aberration", unchanged);
    // Blue's edge 230 px from the centre moves by 2/3 of 0.67 times 0.01 picture heights over 294 px.
    CHECK(measure("edge_position", none) == Approx(230 * 2.0 / 3 * 0.668 * 2.88 / 293.7).epsilon(0.02));
    CHECK(measure("energy", none) == Approx(2 * 2.0 / 3 * 0.668 * 2.88 / 293.7).epsilon(0.02));
}
