#include "test_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <numbers>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// Of the brightest light, 8: float32 sums of up to 137 weighted texels with a quotient; weights are good to some
/// 1e-6, radii to thrice that where most of them is taken off for the blur of the layers themselves.
constexpr double rounding = 2e-5 * 8;

using Scene = std::function<double(int, int)>;
/// Metres; what is beyond 0.9 of the circle at infinity is brought back there.
const Scene scenes[] = {
    [](int x, int y) { return distance_with(0.05 * x - 0.03 * y - 1.013); }, // a slope through the focus
    [](int x, int y) {
        return distance_with((x / 9 + y / 7) % 3 == 0 ? -0.93 : 0.61);
    },                                                                 // a chequered foreground
    [](int x, int) { return x % 23 < 5 ? 4.0 : distance_with(0.87); }, // sharp bars before a blur
    [](int x, int y) { return x % 40 == 20 || y % 30 == 7 ? distance_with(-1.7) : 4.0; }, // near wires
    [](int x, int y) { return distance_with((x / 11 + y / 13) % 2 == 0 ? -0.9 : -0.4); }, // near ones alone
    [](int x, int y) { return distance_with((x / 13 + y / 8) % 2 == 0 ? 0.3 : 0.85); },   // far ones
};

Input noisy(int width, int height, const Scene& distance) {
    return scene(noise(width, height, -1, 8), [&](int x, int y) {
        const double z = distance(x, y), farthest = distance_with(0.9);
        return z < 0 || z > farthest ? farthest : z;
    });
}

} // namespace

TEST_CASE("the picture of the gathering levels is the float64 reference's") {
    const std::pair<int, int> sizes[] = {{1, 1},   {1, 50},   {50, 1},   {300, 31},
                                         {96, 64}, {40, 150}, {131, 177}};
    for (int level : gathering_levels) {
        for (const Scene& distance : scenes) {
            for (const auto& [width, height] : sizes) {
                if (level != medium && width * height > 10000) continue;
                for (double diameter : {2.3, 16.0}) {
                    Values values = lens(diameter, height, perspective, level);
                    if (diameter > 10 && width == 96) values["axial_aberration"] = 0.008;
                    const Worst worst = against_reference(noisy(width, height, distance), values);
                    INFO(level_names[level] << ", scene " << &distance - scenes << ", " << width << "x"
                                            << height << ", circle " << diameter << ", at " << worst.x << ","
                                            << worst.y);
                    CHECK(worst.absolute <= rounding);
                }
            }
        }
    }
}

TEST_CASE("the picture of the level reference is the float64 reference's for circles of 40 px too") {
    const int width = 24, height = 420; // circles of up to a tenth of the height
    for (const double side : {0.95, -0.95}) {
        const Input input =
            noisy(width, height, [&](int x, int) { return x < 12 ? 4.0 : distance_with(side); });
        const Worst worst = against_reference(input, lens(40, height, perspective, reference_level));
        INFO("side " << side << ", at " << worst.x << "," << worst.y);
        CHECK(worst.absolute <= rounding);
    }
}

TEST_CASE("the picture of the level classic is the float64 reference's but for a few roundings") {
    const int width = 61, height = 47;
    for (const Scene& distance : scenes) {
        const Input input = noisy(width, height, distance);
        const Values values = lens(16, height, perspective, classic);
        const Image result = run_effect("depth_of_field", input, values);
        const Image64 expected = reference(reference_input("depth_of_field", input, values));
        int differing = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int c = 0; c < 3; ++c)
                    differing += std::abs(result.at(x, y, c) - expected.at(x, y, c)) > rounding;
            }
        }
        INFO("scene " << &distance - scenes);
        // Where a circle lies on the border of two whole pixels, to float32's 1e-7 in float64.
        CHECK(differing <= 0.002 * width * height * 3);
        CHECK(worst_difference(result, expected).absolute <= 9);
    }
}

TEST_CASE("the picture is the reference's for an orthographic camera") {
    const Camera camera = Camera::parallel(6, 0.1, 100);
    const auto distance = [](int x, int y) { return x < 5 ? double(infinity) : 0.5 + 0.11 * x + 0.013 * y; };
    const Input input{.color = noise(96, 80, -1, 8),
                      .attachments = {{"depth", depth_of(96, 80, camera, distance)}},
                      .camera = camera};
    for (int level : gathering_levels) {
        const Values values = {{"focus_distance", 5},
                               {"focal_length", 500},
                               {"f_number", 0.5},
                               {"max_circle_of_confusion", 0.1},
                               {"axial_aberration", 0.0002},
                               {"quality", level_names[level]}};
        CHECK(against_reference(input, values).absolute <= rounding);
    }
}

TEST_CASE("circles are those of the thin lens from the near plane to infinity") {
    const int width = 200;
    const int height = 720;
    const std::pair<Camera, bool> cameras[] = {
        {Camera::perspective(45, 0.1), true},
        {Camera::perspective(45, 0.1, 1e6, Camera::DepthKind::reversed), true},
        {Camera::perspective(45, 0.1, 1e6, Camera::DepthKind::standard), true},
        {Camera::parallel(12, 0.1, 500), false},
        {Camera::parallel(12, 0.1, 500, Camera::DepthKind::standard), false}};
    for (const auto& [camera, is_perspective] : cameras) {
        const auto distance = [](int x, int) {
            return x == 199 ? double(infinity) : 0.1 * std::pow(5000, x / 198.0);
        };
        const Input input{.color = constant(width, height, {1, 1, 1}),
                          .attachments = {{"depth", depth_of(width, height, camera, distance)}},
                          .camera = camera};
        const Values values = {{"focus_distance", 3},
                               {"focal_length", 85},
                               {"f_number", 2},
                               {"view", 1},
                               {"max_circle_of_confusion", 0.1}};
        const Image shown = run_effect("depth_of_field", input, values);
        for (int x = 0; x < width; ++x) {
            const double z = camera.view_z(input.attachments.at("depth").at(x, 0, 0));
            const double aperture = 0.085 / 2;
            const double expected =
                is_perspective
                    ? aperture * height / (2 * 3 * std::tan(22.5 * std::numbers::pi / 180)) * (1 - 3 / z)
                    : aperture * height / 12 * (z / 3 - 1);
            INFO("column " << x << ", z " << z);
            const double found = shown.at(x, 0, 2) - shown.at(x, 0, 0);
            CHECK(
                found
                == Approx(std::clamp(expected, -72.0, 72.0)).margin(0.01)); // float32 depth, K = 6 to 2000 px
        }
    }
}

TEST_CASE("the plane in focus keeps its bits, beside blur too") {
    const int size = 96;
    Image color = noise(size, size, -3, 9);
    color.at(3, 5, 0) = -0.0f;
    const std::uint32_t payload = 0x7fc01234u;
    std::memcpy(&color.at(4, 6, 1), &payload, sizeof payload);
    // In focus but for circles of 0.9 px, which count as sharp.
    const Input input = scene(color, [](int x, int y) {
        return x >= 48 ? distance_with(0.9) : y < 40 ? 4.0 : distance_with(y < 60 ? 0.1 : -0.1);
    });
    for (int level : {low, medium, ultra, reference_level, classic}) {
        const Image result =
            three_channels(run_effect("depth_of_field", input, lens(9, size, perspective, level)));
        Image expected = result;
        for (int y = 0; y < size; ++y)
            std::memcpy(expected.pixel(0, y), color.pixel(0, y), std::size_t{48} * 3 * sizeof(float));
        INFO(level_names[level]);
        CHECK(same_bits(result, expected));
        CHECK_FALSE(same_bits(result, color));
    }
}

TEST_CASE("the circle in focus is 0 and grows in proportion, not as a square or in steps") {
    // A circle stored in 8 bits around 0.5 would be 0.4 % of the largest in focus (half a step).
    const int columns = 256;
    const Input input =
        scene(Image(columns, 1000, 3), [](int x, int) { return distance_with((x - 128) / 160.0); });
    Values values = lens(100, 1000, perspective);
    values["view"] = 1;
    const Image shown = run_effect("depth_of_field", input, values);
    for (int x = 0; x < columns; ++x) {
        const double circle = shown.at(x, 500, 2) - shown.at(x, 500, 0);
        CHECK(circle == Approx(100 * (x - 128) / 160.0).margin(0.001)); // float32 depth
    }
}

TEST_CASE("hostile depth and light stay where they are") {
    const int size = 64;
    for (const Camera& camera : {perspective, Camera::perspective(40, 0.1, 100, Camera::DepthKind::standard),
                                 Camera::parallel(5, 0.1, 100)}) {
        Image depth = depth_of(size, size, camera, [](int x, int) { return 1 + 0.2 * x; });
        const float hostile[] = {0, 1, -1, 2, not_a_number, infinity, -infinity, 3e38f};
        for (int i = 0; i < 8; ++i)
            depth.at(7 * i + 5, 20 + 3 * i, 0) = hostile[i];
        Input input{.color = noise(size, size, 0, 9), .attachments = {{"depth", depth}}, .camera = camera};
        for (double f_number : {0.5, 2.0, 100.0}) {
            const Image result =
                run_effect("depth_of_field", input, {{"f_number", f_number}}, Format::rgba16f);
            for (float value : result.values)
                CHECK(std::isfinite(value));
        }
        input.color.at(30, 30, 0) = not_a_number;
        input.color.at(34, 30, 1) = infinity;
        const Image result = run_effect("depth_of_field", input, {{"f_number", 0.5}}, Format::rgba16f);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                if (y == 30 && (x == 30 || x == 34)) continue;
                for (int c = 0; c < 3; ++c)
                    CHECK(std::isfinite(result.at(x, y, c)));
            }
        }
    }
}

TEST_CASE("circles larger than the picture are held to it, and the cost does not grow") {
    const Input input{.color = noise(40, 30, 0, 4),
                      .attachments = {{"depth", depth_of(40, 30, perspective, [](int, int) { return 0.2; })}},
                      .camera = perspective};
    const Values values = {
        {"f_number", 0.5}, {"focal_length", 900}, {"focus_distance", 50}, {"max_circle_of_confusion", 0.1}};
    CHECK(against_reference(input, values).absolute <= rounding);
    const Plan plan = plan_effect(
        "depth_of_field",
        Input{.color = Image(1280, 2160, 3), .attachments = input.attachments, .camera = perspective},
        values);
    // 216 px across: even blocks of 16 px, so that the gather's radius stays within 7 texels.
    const auto layers = std::find_if(plan.passes.begin(), plan.passes.end(),
                                     [](const Pass& pass) { return pass.name == "depth_of_field/layers"; });
    CHECK(layers->width == 80);
}

TEST_CASE("without cause the effect does not run, and the picture keeps its bits") {
    Image color = noise(20, 30, -2, 2);
    color.at(3, 3, 0) = -0.0f;
    Input input{.color = color,
                .attachments = {{"depth", depth_of(20, 30, perspective, [](int, int) { return 1.0; })}},
                .camera = perspective};
    Input without_depth = input;
    without_depth.attachments.clear();
    Input tele = input;
    tele.camera.near_plane = 4.9;
    const std::tuple<Input, Values, Moment> cases[] = {
        {input, {{"f_number", 128}}, Moment::configuration},
        {input, {{"max_circle_of_confusion", 0}}, Moment::configuration},
        {tele, {{"f_number", 8}, {"max_circle_of_confusion", 0.1}}, Moment::scene},
        {without_depth, {{"max_circle_of_confusion", 0.1}}, Moment::scene}};
    for (const auto& [given, values, moment] : cases) {
        const Plan plan = plan_effect("depth_of_field", given, values);
        CHECK(plan.passes.empty());
        REQUIRE(plan.effects.size() == 1);
        CHECK(plan.effects[0].moment == moment);
        CHECK(same_bits(run_effect("depth_of_field", given, values), color));
    }
}

TEST_CASE("a lens can't focus within its focal length, and says so") {
    const Input input{.color = Image(64, 64, 3), .attachments = {{"depth", Image(64, 64, 1)}}};
    const Values values = {{"focus_distance", 0.2}, {"focal_length", 200}, {"max_circle_of_confusion", 0.1}};
    CHECK_THROWS_WITH(plan_effect("depth_of_field", input, values),
                      Catch::Contains("beyond its focal length of 200"));
    // Just beyond, where 1 / (S - f) is 10^6: the field of view gives the sensor's distance instead.
    const Values near_limit = {
        {"focus_distance", 0.200001}, {"focal_length", 200}, {"max_circle_of_confusion", 0.1}};
    for (float value : run_effect("depth_of_field", input, near_limit).values)
        CHECK(std::isfinite(value));
}

TEST_CASE("without a focus distance the camera's own counts, and 5 m if it has none") {
    Input input{.color = noise(48, 32, 0, 1), .attachments = {{"depth", Image(48, 32, 1)}}};
    for (std::size_t i = 0; i < std::size_t{48} * 32; ++i) {
        const double z = 1 + 0.01 * static_cast<double>(i);
        input.attachments["depth"].values[i] = static_cast<float>(input.camera.depth_at(z));
    }
    const auto run = [&](double camera_focus, double focus) {
        input.camera.focus_distance = camera_focus;
        return run_effect("depth_of_field", input,
                          {{"focus_distance", focus}, {"max_circle_of_confusion", 0.1}, {"f_number", 0.5}});
    };
    CHECK(same_bits(run(3, 0), run(0, 3)));
    CHECK(same_bits(run(0, 0), run(0, 5)));
    CHECK(same_bits(run(7, 3), run(0, 3)));
    CHECK_FALSE(same_bits(run(3, 0), run(0, 0)));
}
