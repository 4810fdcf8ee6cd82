// Truths of fog, rim light and layered occlusion of scenes, against closed forms.
#include <catch2/catch.hpp>

#include <testing.hpp>
#include <truths/truth_run.hpp>

#include <cmath>
#include <memory>
#include <numbers>

using namespace postfx::host;
using postfx::Image64;

namespace {

constexpr double pi = std::numbers::pi;

TruthResult truth(const std::string& yaml, const std::string& effect, const std::string& kind, int size,
                  int samples, const std::map<std::string, double>& values, double given = -1,
                  int scene_samples = 1) {
    postfx::Chain chain;
    postfx::ChainEntry entry = chain.add(postfx::testing::catalog(), effect);
    for (const auto& [name, value] : values)
        REQUIRE(entry.set(name, value));
    TruthRequest request{.scene = parse_scene(yaml, "test.yaml"),
                         .width = size,
                         .height = size,
                         .scene_samples = scene_samples,
                         .entry = entry};
    if (given >= 0) request.given = std::make_shared<const Image64>(size, size, 3, given);
    TruthRun run(find_truth(effect, kind), request, samples);
    while (!run.complete())
        run.step();
    return run.result();
}

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
/// A sphere of radius 1 fills 0.8 of the picture's width.
const std::string ball = white + R"(
camera: {position: [0, 0, 5], look_at: [0, 0, 0], orthographic_extent: 2.5, near: 0.5, far: 100}
nodes:
  - {mesh: {sphere: {radius: 1, segments: 256}}, material: white}
)";

} // namespace

TEST_CASE("even fog before a wall is Beer's law along the ray") {
    constexpr int size = 33;
    const TruthResult result =
        truth(wall_ahead, "fog", "scene", size, 2,
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
    const std::map<std::string, double> values = {{"density", 0.05}, {"height_falloff", 0.1}, {"color", 1}};
    const Image64 result = truth(floor_from_above, "fog", "scene", 8, 2, values, 0).picture;
    for (const double value : result.values)
        CHECK(value == Approx(-std::expm1(-thickness)).margin(1e-6)); // float32 depth of 49.5 m
    std::map<std::string, double> thin = values;
    thin["max_opacity"] = 0.1;
    CHECK(truth(floor_from_above, "fog", "scene", 8, 2, thin, 5).picture.values[0]
          == Approx(5 * 0.9 + 0.1).epsilon(1e-14));
}

TEST_CASE("fog before the sky is what lies over the eye, and all of it on the way down") {
    const std::string sky =
        "camera: {position: [0, 10, 0], look_at: [0, 10, -1], vertical_fov: 60, near: 0.1}\n";
    constexpr int size = 33;
    const Image64 result = truth(sky, "fog", "scene", size, 2,
                                 {{"density", 0.05}, {"height_falloff", 0.1}, {"color", 1}, {"sky", 1}}, 0)
                               .picture;
    const double tangent = std::tan(30 * pi / 180);
    for (int y = 0; y < size; ++y) {
        const double up = (y - 16) / 16.5 * tangent, rise = up / std::sqrt(1 + up * up);
        const double expected = y <= 16 ? 1 : -std::expm1(-0.05 * std::exp(-1.0) / (0.1 * rise));
        CHECK(result.at(16, y, 0) == Approx(expected).margin(1e-9));
    }
}

TEST_CASE("a sphere's rim has the mean of its closed form, from its normals and from its surface") {
    constexpr int size = 100;
    const double pixels_of_disc = pi * 40 * 40;
    for (const double width : {0.25, 1.0, 2.0}) {
        const double mean = width <= 1 ? width * width / 3 : 1 - 2 / (3 * width);
        for (const char* kind : {"layer", "scene"}) {
            const bool is_scene = std::string(kind) == "scene";
            const TruthResult result = truth(ball, "rim_light", kind, size, is_scene ? 64 : 2,
                                             {{"width", width}, {"strength", 2}, {"color", 1}}, 0);
            double sum = 0;
            for (std::size_t i = 0; i < result.picture.values.size(); i += 3)
                sum += result.picture.values[i] / 2;
            INFO(kind << ", width " << width);
            // One normal per pixel counts the rim's in whole pixels: 250 on the circle, each 0.3 off at random. 64
            // rays leave the corners of 256 segments: 1e-4.
            CHECK(sum / pixels_of_disc == Approx(mean).margin(is_scene ? 3e-4 : 4e-3));
            // On the circle, a pixel is half rim and half nothing: 64 rays in two dimensions.
            CHECK(result.own_error < (is_scene ? 0.06 : 12 * 0x1p-53));
        }
    }
}

TEST_CASE("each pixel of a sphere has the rim of its angle") {
    constexpr int size = 100;
    const double index = 1.5;
    for (const bool mirrors : {false, true}) {
        const std::map<std::string, double> values = {
            {"width", 0.7}, {"profile", mirrors}, {"refractive_index", index}, {"strength", 1}, {"color", 1}};
        const Image64 layer = truth(ball, "rim_light", "layer", size, 2, values, 0.5).picture;
        const Image64 scene = truth(ball, "rim_light", "scene", size, 256, values, 0.5).picture;
        for (int x = 12; x < 88; x += 3) {
            const double cosine = std::sqrt(1 - (std::pow(x - 49.5, 2) + 0.25) / 1600);
            const double in = std::acos(cosine), out = std::asin(std::sin(in) / index);
            const double fresnel = (std::pow(std::sin(in - out) / std::sin(in + out), 2)
                                    + std::pow(std::tan(in - out) / std::tan(in + out), 2))
                                   / 2;
            const double share = mirrors ? fresnel : std::max(1 - cosine / 0.7, 0.0);
            INFO("column " << x << (mirrors ? ", fresnel" : ", ramp"));
            // Normals are half floats, off by 5e-4, times the slope; the mean over a pixel bends by that over its
            // width.
            CHECK(layer.at(x, 50, 1) == Approx(0.5 + share).margin(3e-3));
            CHECK(scene.at(x, 50, 1) == Approx(0.5 + share).margin(5e-3));
        }
        CHECK(layer.at(2, 2, 0) == 0.5);
        CHECK(scene.at(2, 2, 0) == 0.5);
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
    const TruthResult shown = truth(corner, "ssao", "layer", size, 256, {{"view", 1}, {"falloff", 0}});
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
        truth(corner, "ssao", "layer", size, 256, {{"strength", 0.5}, {"falloff", 0}}, 3).picture;
    for (std::size_t i = 0; i < half.values.size(); i += 97)
        CHECK(half.values[i] == Approx(3 - 0.5 * (1 - shown.picture.values[i])).margin(1e-12));
}
