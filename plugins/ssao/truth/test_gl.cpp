// Truths of occlusion in scenes, against closed forms.
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
/// Orthographic from above, 2 m high, on a floor; world x and z are -1..1 over the picture.
constexpr const char* from_above = R"(
camera: {position: [0, 5, 0], look_at: [0, 0, 0], up: [0, 0, -1], orthographic_extent: 2, near: 0.1, far: 10}
ambient: {above: [1, 1, 1], below: [1, 1, 1]}
materials:
  white: {diffuse: 1, specular: 0}
)";

/// Occluded share of a floor at the distance d from a wall, by surfaces nearer than r.
double wall_occlusion(double d, double r) {
    const double k = std::min(d / r, 1.0);
    return (std::acos(k) - k * std::sqrt(1 - k * k)) / std::numbers::pi;
}

double floor_and_wall_error(double falloff) {
    const std::string scene = std::string(from_above) + R"(
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [40, 40]}}, material: white}
  - {position: [1.3, 1, 0], mesh: {box: {size: [1, 2, 40]}}, material: white}
)";
    constexpr int size = 24;
    const Image64 result =
        truth_of(request_of("ssao", scene, size, {{"view", 1}, {"falloff", falloff}}), "scene", 256).picture;
    double sum = 0;
    int count = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double distance = 0.8 - (2 * (x + 0.5) / size - 1);
            if (distance <= 0) continue;
            // A linear falloff is the mean over sharp radii.
            constexpr int radii = 64;
            double expected = 0;
            for (int i = 0; i < radii; ++i)
                expected += wall_occlusion(distance, 1 - falloff * (i + 0.5) / radii) / radii;
            const double error = 1 - result.at(x, y, 0) - expected;
            sum += error * error;
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

} // namespace

TEST_CASE("an open plane and the sky are not occluded at all") {
    const std::string scene = R"(
camera: {position: [0, 1, 0], look_at: [0, 0.8, -1], vertical_fov: 60, near: 0.1}
materials:
  white: {diffuse: 1, specular: 0}
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [200, 200]}}, material: white}
)";
    const Image64 result =
        truth_of(request_of("ssao", scene, 32, {{"view", 1}, {"radius", 3}}), "scene", 64).picture;
    for (const double value : result.values)
        REQUIRE(value == 1);
}

TEST_CASE("a wall occludes the floor by the closed form") {
    // 256 rays: stratified, 0.003; 0.02 if they were random.
    CHECK(floor_and_wall_error(0) < 0.006);
    CHECK(floor_and_wall_error(0.6) < 0.006);
}

TEST_CASE("occlusion takes the ambient share by its strength") {
    const std::string scene = std::string(from_above) + R"(
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [40, 40]}}, material: white}
  - {position: [1.3, 1, 0], mesh: {box: {size: [1, 2, 40]}}, material: white}
)";
    const Image64 visible = truth_of(request_of("ssao", scene, 16, {{"view", 1}}), "scene", 16).picture;
    const Image64 whole = truth_of(request_of("ssao", scene, 16), "scene", 16).picture;
    const Image64 half = truth_of(request_of("ssao", scene, 16, {{"strength", 0.5}}), "scene", 16).picture;
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        CHECK(whole.values[i]
              == Approx(visible.values[i]).margin(1e-12)); // all of the light is ambient, and 1
        CHECK(half.values[i] == Approx((1 + visible.values[i]) / 2).margin(1e-12));
    }
}

TEST_CASE("one layer of depth and normals knows a wall that is in view") {
    // Floor and wall, both 45 degrees from the view axis, meet in the middle.
    const std::string corner = white + R"(
camera: {position: [0, 4, 4], look_at: [0, 0, 0], orthographic_extent: 4, near: 0.1, far: 20}
ambient: {above: [1, 1, 1], below: [1, 1, 1]}
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [40, 40]}}, material: white}
  - {position: [0, 10, -0.5], mesh: {box: {size: [40, 20, 1]}}, material: white}
)";
    constexpr int size = 96;
    const TruthResult shown = truth_in("ssao", corner, "layer", size, 256, {{"view", 1}, {"falloff", 0}});
    double sum = 0;
    for (int y = 0; y < size; ++y) {
        const double k = std::min(std::abs(y + 0.5 - 0.5 * size) * 4 / size / std::sqrt(0.5), 1.0);
        const double expected = 1 - (std::acos(k) - k * std::sqrt(1 - k * k)) / pi;
        sum += std::pow(shown.picture.at(size / 2, y, 0) - expected, 2) / size;
    }
    // A pixel is 6 % of the radius, and decides at the foot and at the end.
    CHECK(std::sqrt(sum) < 0.008);
    CHECK(shown.own_error < 0.002);

    const Image64 half =
        truth_in("ssao", corner, "layer", size, 256, {{"strength", 0.5}, {"falloff", 0}}, 3).picture;
    for (std::size_t i = 0; i < half.values.size(); i += 97)
        CHECK(half.values[i] == Approx(3 - 0.5 * (1 - shown.picture.values[i])).margin(1e-12));
}
