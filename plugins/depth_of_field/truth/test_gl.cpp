// Truths of a thin lens in scenes, against closed forms.
#include <catch2/catch.hpp>

#include <truth_of.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace postfx::host;
using namespace postfx::testing;
using postfx::Image64;

namespace {

constexpr const char* focused_camera = R"(
camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 40, near: 0.1, focus_distance: 2}
materials:
  light: {diffuse: 0, specular: 0, emission: [1, 1, 1]}
)";

/// The circle of a surface at `distance` through a lens of 0.4 m diameter, pixels of a picture `height` high.
double circle(double distance, int height) {
    const double tan_half = std::tan(20 * std::numbers::pi / 180);
    return 0.4 * height / (2 * 2 * tan_half) * (1 - 2 / distance);
}
const Numbers wide_open = {{"focal_length", 400}, {"f_number", 1}};

constexpr const char* from_above = R"(
camera: {position: [0, 5, 0], look_at: [0, 0, 0], up: [0, 0, -1], orthographic_extent: 2, near: 0.1, far: 10}
)";

} // namespace

TEST_CASE("a small light out of focus becomes a disc of the thin lens' diameter") {
    constexpr int size = 64;
    for (const double distance : {1.2, 4.0}) {
        // 2 pixels wide, flat, its front at the distance.
        const double pixel = 2 * std::tan(20 * std::numbers::pi / 180) * distance / size, side = 2 * pixel;
        const std::string scene = std::string(focused_camera) + "nodes:\n  - {position: [0, 0, "
                                  + std::to_string(-distance - 0.0005) + "], mesh: {box: {size: ["
                                  + std::to_string(side) + ", " + std::to_string(side)
                                  + ", 0.001]}}, material: light}\n";
        for (const char* kind : {"scene", "layer"}) {
            const Image64 result =
                truth_of(request_of("depth_of_field", scene, size, wide_open), kind, 512).picture;
            double light = 0, spread = 0;
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    const double value = result.at(x, y, 0), u = x - 31.5, v = y - 31.5;
                    light += value;
                    spread += value * (u * u + v * v);
                }
            }
            // Second moments: c^2 / 8 of the disc, 4/6 of the light, and 1/6 of a pixel.
            const double diameter = std::sqrt(8 * (spread / light - 5.0 / 6));
            INFO(kind << " at " << distance);
            // The layer's pixels are whole ones; the scene's have 4 samples.
            CHECK(diameter == Approx(std::abs(circle(distance, size))).margin(0.15));
            CHECK(light == Approx(4).margin(0.08));
        }
    }
}

TEST_CASE("a near edge covers as a disc does, on both sides of it") {
    // Left half: a light at 1 m; nothing behind.
    const std::string scene =
        std::string(focused_camera)
        + "nodes:\n  - {position: [-5, 0, -1.0005], mesh: {box: {size: [10, 10, 0.001]}}, "
          "material: light}\n";
    constexpr int size = 64;
    const Image64 result =
        truth_of(request_of("depth_of_field", scene, size, wide_open), "scene", 512).picture;
    const double radius = std::abs(circle(1, size)) / 2;
    for (int x = 8; x < size - 8; ++x) {
        const double t = std::clamp((32 - x - 0.5) / radius, -1.0, 1.0);
        const double expected = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
        INFO(x);
        // 512 points of the lens; 4 samples tell a pixel's part in quarters.
        CHECK(result.at(x, size / 2, 1) == Approx(expected).margin(0.015));
    }
}

TEST_CASE("what is in focus stays as it is without a lens") {
    const std::string scene = std::string(focused_camera) + R"(nodes:
  - {position: [0.07, 0.03, -2.0005], mesh: {box: {size: [0.61, 0.37, 0.001]}}, material: light}
)";
    const Image64 sharp =
        truth_of(request_of("depth_of_field", scene, 48, {{"f_number", 128}}), "scene", 2).picture;
    const Image64 result = truth_of(request_of("depth_of_field", scene, 48, wide_open), "scene", 64).picture;
    // Edges are placed in steps of 1/256 pixel, so one of four samples may fall on the other side from some points.
    CHECK(root_mean_square_difference(sharp, result) < 0.01);
    CHECK(result.at(25, 25, 0) == 1);
}

TEST_CASE("no lens looks through an orthographic camera") {
    CHECK_THROWS_WITH(truth_of(request_of("depth_of_field", from_above, 8), "scene", 2),
                      Catch::Contains("orthographic"));
}
