// The truth of fog in scenes, against closed forms.
#include <catch2/catch.hpp>

#include <truth_of.hpp>

#include <cmath>
#include <numbers>

using namespace postfx::host;
using namespace postfx::testing;
using postfx::Image64;

namespace {

constexpr double pi = std::numbers::pi;

const std::string white = "materials:\n  white: {diffuse: 1, specular: 0}\n";
const std::string wall_ahead = white + R"(
camera: {position: [0, 3, 0], look_at: [0, 3, -1], vertical_fov: 60, near: 0.1}
nodes:
  - {position: [0, 3, -20.5], mesh: {box: {size: [2000, 6, 1]}}, material: white}
)";
const std::string floor_from_above = white + R"(
camera: {position: [0, 50, 0], look_at: [0, 0, 0], up: [0, 0, -1], orthographic_extent: 2, near: 0.5, far: 100}
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [40, 40]}}, material: white}
)";

} // namespace

TEST_CASE("even fog before a wall is Beer's law along the ray") {
    constexpr int size = 33;
    const TruthResult result =
        truth_in("fog", wall_ahead, "scene", size, 2,
                 {{"density", 0.03}, {"height_falloff", 0}, {"color", 0.25}, {"start", 4}}, 2);
    const double tangent = std::tan(30 * pi / 180);
    for (const int x : {0, 5, 16, 32}) {
        for (const int y : {14, 16}) { // of the wall, which ends above and below
            const double right = (x - 16) / 16.5 * tangent, up = (y - 16) / 16.5 * tangent;
            const double share = std::exp(-0.03 * (20 * std::sqrt(1 + right * right + up * up) - 4));
            // Depth is in float32, and drawn with a triangle's corners on a grid of 1/256 pixel.
            CHECK(result.picture.at(x, y, 0) == Approx(2 * share + 0.25 * (1 - share)).margin(2e-6));
        }
    }
    CHECK(result.picture.at(16, 32, 1) == 2); // the sky is left as it is
    CHECK(result.own_error > 0);
    CHECK(result.own_error < 1e-10); // two rules in float64, hundreds of steps
}

TEST_CASE("fog over the floor has the thickness of its height, from the near plane on") {
    // From 49.5 m down to 0: (1 - e^-0.1*49.5) / 0.1 metres at full density.
    const double thickness = 0.05 * -std::expm1(-0.1 * 49.5) / 0.1;
    const Numbers values = {{"density", 0.05}, {"height_falloff", 0.1}, {"color", 1}};
    const Image64 result = truth_in("fog", floor_from_above, "scene", 8, 2, values, 0).picture;
    for (const double value : result.values)
        CHECK(value == Approx(-std::expm1(-thickness)).margin(1e-6)); // float32 depth of 49.5 m
    Numbers thin = values;
    thin["max_opacity"] = 0.1;
    CHECK(truth_in("fog", floor_from_above, "scene", 8, 2, thin, 5).picture.values[0]
          == Approx(5 * 0.9 + 0.1).epsilon(1e-14));
}

TEST_CASE("fog before the sky is what lies over the eye, and all of it on the way down") {
    const std::string sky =
        "camera: {position: [0, 10, 0], look_at: [0, 10, -1], vertical_fov: 60, near: 0.1}\n";
    constexpr int size = 33;
    const Image64 result = truth_in("fog", sky, "scene", size, 2,
                                    {{"density", 0.05}, {"height_falloff", 0.1}, {"color", 1}, {"sky", 1}}, 0)
                               .picture;
    const double tangent = std::tan(30 * pi / 180);
    for (int y = 0; y < size; ++y) {
        const double up = (y - 16) / 16.5 * tangent, rise = up / std::sqrt(1 + up * up);
        const double expected = y <= 16 ? 1 : -std::expm1(-0.05 * std::exp(-1.0) / (0.1 * rise));
        CHECK(result.at(16, y, 0) == Approx(expected).margin(1e-9));
    }
}
