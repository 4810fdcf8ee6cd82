// Truths of scenes against closed forms, and what holds for every truth: its own error, stopping and going on.
#include <catch2/catch.hpp>

#include <temporary_directory.hpp>
#include <testing.hpp>
#include <truths/truth_run.hpp>

#include <postfx/error.hpp>

#include <cmath>
#include <fstream>
#include <numbers>

using namespace postfx::host;
using postfx::Image64;
using postfx::testing::TemporaryDirectory;

namespace {

TruthRequest request(const std::string& yaml, const std::string& effect, int size,
                     const std::map<std::string, double>& values = {}) {
    postfx::Chain chain;
    postfx::ChainEntry entry = chain.add(postfx::testing::catalog(), effect);
    for (const auto& [name, value] : values)
        REQUIRE(entry.set(name, value));
    return {.scene = parse_scene(yaml, "test.yaml"), .width = size, .height = size, .entry = entry};
}

TruthResult truth(const TruthRequest& request, const std::string& kind, int samples) {
    TruthRun run(find_truth(request.entry.effect->id, kind), request, samples);
    while (!run.complete())
        run.step();
    return run.result();
}

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
const std::map<std::string, double> wide_open = {{"focal_length", 400}, {"f_number", 1}};

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
        truth(request(scene, "ssao", size, {{"view", 1}, {"falloff", falloff}}), "scene", 256).picture;
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

/// Something near, in focus and far, in two colours, with edges.
const std::string room = R"(
camera: {position: [0, 1, 3], look_at: [0, 0.5, 0], vertical_fov: 45, near: 0.1, focus_distance: 3}
ambient: {above: [0.4, 0.5, 0.6], below: [0.3, 0.2, 0.1]}
materials:
  white: {diffuse: 1, specular: 0}
  lamp: {diffuse: 0.5, specular: 0, emission: [3, 2, 1]}
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [8, 8]}}, material: white}
  - {position: [0, 0.3, 0], mesh: {box: {size: [0.6, 0.6, 0.6]}}, material: white}
  - {position: [0.6, 0.8, 1.5], mesh: {sphere: {radius: 0.2}}, material: lamp}
  - {position: [-1, 0.6, -2], mesh: {sphere: {radius: 0.5}}, material: lamp}
)";

TruthRequest room_request(const RegisteredTruth& registered, int size) {
    const std::map<std::string, double> values =
        registered.effect == "depth_of_field" ? wide_open : std::map<std::string, double>{};
    return request(room, registered.effect, size, values);
}

double root_mean_square_difference(const Image64& a, const Image64& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        sum += (a.values[i] - b.values[i]) * (a.values[i] - b.values[i]);
    return std::sqrt(sum / static_cast<double>(a.values.size()));
}

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
                truth(request(scene, "depth_of_field", size, wide_open), kind, 512).picture;
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
    const Image64 result = truth(request(scene, "depth_of_field", size, wide_open), "scene", 512).picture;
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
        truth(request(scene, "depth_of_field", 48, {{"f_number", 128}}), "scene", 2).picture;
    const Image64 result = truth(request(scene, "depth_of_field", 48, wide_open), "scene", 64).picture;
    // Edges are placed in steps of 1/256 pixel, so one of four samples may fall on the other side from some points.
    CHECK(root_mean_square_difference(sharp, result) < 0.01);
    CHECK(result.at(25, 25, 0) == 1);
}

TEST_CASE("no lens looks through an orthographic camera") {
    CHECK_THROWS_WITH(truth(request(from_above, "depth_of_field", 8), "scene", 2),
                      Catch::Contains("orthographic"));
}

TEST_CASE("an open plane and the sky are not occluded at all") {
    const std::string scene = R"(
camera: {position: [0, 1, 0], look_at: [0, 0.8, -1], vertical_fov: 60, near: 0.1}
materials:
  white: {diffuse: 1, specular: 0}
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [200, 200]}}, material: white}
)";
    const Image64 result =
        truth(request(scene, "ssao", 32, {{"view", 1}, {"radius", 3}}), "scene", 64).picture;
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
    const Image64 visible = truth(request(scene, "ssao", 16, {{"view", 1}}), "scene", 16).picture;
    const Image64 whole = truth(request(scene, "ssao", 16), "scene", 16).picture;
    const Image64 half = truth(request(scene, "ssao", 16, {{"strength", 0.5}}), "scene", 16).picture;
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        CHECK(whole.values[i]
              == Approx(visible.values[i]).margin(1e-12)); // all of the light is ambient, and 1
        CHECK(half.values[i] == Approx((1 + visible.values[i]) / 2).margin(1e-12));
    }
}

TEST_CASE("every truth knows its own error, which falls as it should") {
    for (const RegisteredTruth& registered : registered_truths()) {
        INFO(registered.effect << " " << registered.kind);
        const TruthRequest asked = room_request(registered, 40);
        if (registered.samples == 2) {
            // Reckoned in two ways, which do not sample: only rounding and steps are between them.
            CHECK(truth(asked, registered.kind, 2).own_error < 1e-9);
            continue;
        }
        const TruthResult little = truth(asked, registered.kind, 32),
                          more = truth(asked, registered.kind, 128),
                          much = truth(asked, registered.kind, 2048);
        INFO("own error " << little.own_error << " with 32, " << more.own_error << " with 128, "
                          << much.own_error << " with 2048 samples");
        CHECK(more.own_error > 0);
        // 4 times the samples: half the error of random ones. A tenth more for the error's own error.
        CHECK(more.own_error < 0.55 * little.own_error);
        CHECK(much.own_error < 0.275 * more.own_error);
        // The claim against what a much better one says.
        const double error = root_mean_square_difference(more.picture, much.picture) / much.root_mean_square;
        CHECK(more.own_error > 0.7 * error);
        CHECK(more.own_error < 1.5 * error);
    }
}

TEST_CASE("every truth goes on where it was stopped, to the same bits") {
    const TemporaryDirectory folder;
    for (const RegisteredTruth& registered : registered_truths()) {
        INFO(registered.effect << " " << registered.kind);
        const TruthRequest asked = room_request(registered, 16);
        const TruthResult whole = truth(asked, registered.kind, 16);

        TruthRun first(registered, asked, 16);
        const auto file = folder / first.file_name();
        CHECK_FALSE(first.resume(file));
        while (first.done() < 7)
            first.step();
        first.save(file);

        TruthRun second(registered, asked, 16);
        REQUIRE(second.file_name() == first.file_name());
        REQUIRE(second.resume(file));
        CHECK(second.done() == 7);
        while (!second.complete())
            second.step();
        CHECK(second.result().picture.values == whole.picture.values);
        CHECK(second.result().own_error == whole.own_error);
    }
}

TEST_CASE("sums of another truth are not taken, damaged ones are refused") {
    const TemporaryDirectory folder;
    const auto file = folder / "a.sums";
    const RegisteredTruth& registered = find_truth("ssao", "scene");
    TruthRun run(registered, request(room, "ssao", 8), 4);
    run.step();
    run.save(file);

    TruthRun other(registered, request(room, "ssao", 8, {{"radius", 0.5}}), 4);
    CHECK_FALSE(other.resume(file));
    CHECK(other.file_name() != run.file_name());
    TruthRun longer(registered, request(room, "ssao", 8), 6);
    CHECK_FALSE(longer.resume(file));
    // What is done with the sum does not change it.
    CHECK(TruthRun(registered, request(room, "ssao", 8, {{"strength", 0.5}, {"view", 1}}), 4).resume(file));

    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 8);
    CHECK_THROWS_WITH(run.resume(file), Catch::Contains("damaged") && Catch::Contains("a.sums"));
    std::ofstream(file) << "something else";
    CHECK_THROWS_WITH(run.resume(file), Catch::Contains("JSON"));
}

TEST_CASE("a truth that is not there is refused with those that are") {
    CHECK_THROWS_WITH(find_truth("fog", "layer"), Catch::Contains("it has scene"));
    CHECK_THROWS_WITH(find_truth("nothing", "scene"), Catch::Contains("depth_of_field (layer)"));
    CHECK_THROWS_AS(TruthRun(find_truth("ssao", "scene"), request(room, "ssao", 8), 3), postfx::Error);
}
