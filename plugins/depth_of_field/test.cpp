#include <testing.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

Image three_channels(const Image& image) {
    Image result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            std::memcpy(result.pixel(x, y), image.pixel(x, y), 3 * sizeof(float));
    }
    return result;
}

/// Raw depth samples for distances in metres.
Image depth_of(int width, int height, const Camera& camera, const std::function<double(int, int)>& distance) {
    Image depth(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            depth.at(x, y, 0) = static_cast<float>(camera.depth_at(distance(x, y)));
    }
    return depth;
}

/// A lens whose circle at infinity is `diameter` pixels in a picture of `height` pixels, focused at 4 m (or
/// the largest that there is, in pictures of few rows).
Values lens(double diameter, int height, const Camera& camera) {
    const double aperture = diameter * 2 * 4 * camera.tan_half_fov() / height;
    return {{"focus_distance", 4},
            {"focal_length", std::min(1000 * aperture, 1000.0)},
            {"f_number", 1},
            {"max_circle_of_confusion", 0.1}};
}
/// Where that lens has a circle of `diameter` times that at infinity (below 0: before the focus plane).
double distance_with(double relative_diameter) {
    return 4 / (1 - relative_diameter);
}

const Camera perspective = Camera::perspective(40, 0.1);

Worst against_reference(const Input& input, const Values& values) {
    return worst_difference(run_effect("depth_of_field", input, values),
                            reference(reference_input("depth_of_field", input, values)));
}

double sum_of(const Image& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            sum += image.at(x, y, channel);
    }
    return sum;
}

/// Float32 sums of up to 137 weighted texels, with a quotient; weights are good to some 1e-6.
constexpr double rounding = 1e-5;

} // namespace

TEST_CASE("the picture is the float64 reference's") {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 50}, {50, 1}, {300, 31}, {96, 64}, {131, 177}};
    const double largest =
        0.9; // of the circle at infinity; what a scene puts beyond it is brought back there
    const std::function<double(int, int)> scenes[] = {
        [](int x, int y) { return distance_with(0.05 * x - 0.03 * y - 1.013); }, // a slope through the focus
        [](int x, int y) {
            return distance_with((x / 9 + y / 7) % 3 == 0 ? -0.93 : 0.61);
        },                                                                 // a chequered foreground
        [](int x, int) { return x % 23 < 5 ? 4.0 : distance_with(0.87); }, // sharp bars before a blur
        [](int x, int y) { return x % 40 == 20 || y % 30 == 7 ? distance_with(-1.7) : 4.0; }, // near wires
    };
    for (const auto& scene : scenes) {
        for (const auto& [width, height] : sizes) {
            for (double diameter : {2.3, 9.0, 16.0}) {
                const auto bounded = [&](int x, int y) {
                    const double z = scene(x, y);
                    return z < 0 || z > distance_with(largest) ? distance_with(largest) : z;
                };
                const Input input{.color = noise(width, height, -1, 8),
                                  .attachments = {{"depth", depth_of(width, height, perspective, bounded)}},
                                  .camera = perspective};
                const Values values = lens(diameter, height, perspective);
                const Worst worst = against_reference(input, values);
                INFO("scene " << &scene - scenes << ", " << width << "x" << height << ", circle " << diameter
                              << ", at " << worst.x << "," << worst.y);
                CHECK(worst.absolute <= 8 * rounding);
            }
        }
    }
}

TEST_CASE("the picture is the reference's for an orthographic camera") {
    const Camera camera = Camera::parallel(6, 0.1, 100);
    const auto scene = [](int x, int y) { return x < 5 ? double(infinity) : 0.5 + 0.11 * x + 0.013 * y; };
    const Input input{.color = noise(96, 80, -1, 8),
                      .attachments = {{"depth", depth_of(96, 80, camera, scene)}},
                      .camera = camera};
    const Values values = {
        {"focus_distance", 5}, {"focal_length", 500}, {"f_number", 0.5}, {"max_circle_of_confusion", 0.1}};
    CHECK(against_reference(input, values).absolute <= 8 * rounding);
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
    const auto half = [](int x, int) { return x < 48 ? 4.0 : distance_with(0.9); };
    const Input input{.color = color,
                      .attachments = {{"depth", depth_of(size, size, perspective, half)}},
                      .camera = perspective};
    const Image result = three_channels(run_effect("depth_of_field", input, lens(9, size, perspective)));
    Image left = color, expected = result;
    for (int y = 0; y < size; ++y) {
        std::memcpy(expected.pixel(0, y), color.pixel(0, y), std::size_t{48} * 3 * sizeof(float));
    }
    CHECK(same_bits(result, expected));
    CHECK_FALSE(same_bits(result, color));
}

TEST_CASE("constant light stays constant whatever the depth") {
    for (const auto& [width, height] :
         {std::pair{1, 1}, std::pair{70, 51}, std::pair{1, 64}, std::pair{200, 3}}) {
        Image depth = noise(width, height, 0, 1);
        for (float& value : depth.values)
            value = value * value * value;
        depth.channels = 1; // its first third
        depth.values.resize(depth.pixel_count());
        for (float light : {0.0f, 6.1e-5f, 1.0f, 65504.0f}) {
            const Input input{.color = constant(width, height, {light, light, light}),
                              .attachments = {{"depth", depth}},
                              .camera = perspective};
            const Values values = {{"focus_distance", 1}, {"f_number", 1}, {"max_circle_of_confusion", 0.1}};
            const Worst worst =
                worst_difference(run_effect("depth_of_field", input, values), convert<double>(input.color));
            CHECK(worst.absolute <= light * rounding);
        }
    }
}

TEST_CASE("a point inside the picture keeps its energy and spreads as a disc of the circle's diameter") {
    const int size = 128;
    for (double relative : {0.8, -0.8}) {
        for (double diameter : {6.0, 12.0, 15.0}) {
            const auto plane = [&](int, int) { return distance_with(relative); };
            const Input input{.color = impulse(size, size, 64, 61, 100),
                              .attachments = {{"depth", depth_of(size, size, perspective, plane)}},
                              .camera = perspective};
            Values values = lens(diameter / 0.8, size, perspective);
            const Image result = run_effect("depth_of_field", input, values);
            const double energy = sum_of(result, 0) / 100;
            double x_mean = 0, variance = 0;
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x)
                    x_mean += result.at(x, y, 0) * double(x) / 100 / energy;
            }
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x)
                    variance += std::pow(x - x_mean, 2) * result.at(x, y, 0) / 100 / energy;
            }
            INFO("diameter " << diameter << ", side " << relative);
            const double limit = std::min(diameter, 0.1 * size);
            CHECK(energy == Approx(1).margin(0.005));
            // A uniform disc's variance on an axis is d^2/16; half resolution adds the block (1/3) and linear
            // interpolation (2/3).
            CHECK(4 * std::sqrt(variance - 1) == Approx(limit).margin(0.4));
        }
    }
}

TEST_CASE("a sharp bright edge does not leak into the blur behind it") {
    const int size = 96;
    for (int edge : {47, 48}) { // within a block of the reduced layer and between two
        Image color(size, size, 3);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x)
                for (int c = 0; c < 3; ++c)
                    color.at(x, y, c) = x < edge ? 1000.0f : 0.5f;
        }
        const auto scene = [&](int x, int) { return x < edge ? 4.0 : distance_with(0.9); };
        const Input input{.color = color,
                          .attachments = {{"depth", depth_of(size, size, perspective, scene)}},
                          .camera = perspective};
        // The truth is the input: a sharp edge hides a constant background. The gate is 0.5 % of 1000.
        const Worst worst = worst_difference(run_effect("depth_of_field", input, lens(9, size, perspective)),
                                             convert<double>(color));
        CHECK(worst.absolute <= 1000 * 1e-6);
    }
}

TEST_CASE("a near edge spreads over the sharp background as a disc's edge does") {
    const int size = 128;
    const double diameter = 12;
    Image color(size, size, 3);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < 64; ++x)
            color.at(x, y, 0) = 1;
    }
    const auto scene = [](int x, int) { return x < 64 ? distance_with(-0.9) : 4.0; };
    const Input input{.color = color,
                      .attachments = {{"depth", depth_of(size, size, perspective, scene)}},
                      .camera = perspective};
    const Image result = run_effect("depth_of_field", input, lens(diameter / 0.9, size, perspective));
    double worst = 0;
    for (int x = 40; x < 88; ++x) {
        // Coverage at t radii from the edge: 1/2 + (t sqrt(1 - t^2) + asin t) / pi.
        const double t = std::clamp((64 - (x + 0.5)) / (diameter / 2), -1.0, 1.0);
        const double truth = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
        worst = std::max(worst, std::abs(result.at(x, 64, 0) - truth));
    }
    // Half resolution softens the disc's edge by a texel of 2 pixels in 12.
    CHECK(worst <= 0.06);
    CHECK((result.at(63, 64, 0) + result.at(64, 64, 0)) / 2 == Approx(0.5).margin(0.04));
    CHECK(result.at(30, 64, 0) == Approx(1).margin(1e-4));
    CHECK(result.at(100, 64, 0) == 0);
}

TEST_CASE("twice the light, twice the picture, bit for bit") {
    const Image color = noise(71, 43, -1, 8);
    const auto scene = [](int x, int y) { return distance_with(0.04 * x - 0.05 * y - 0.9); };
    Input input{.color = color,
                .attachments = {{"depth", depth_of(71, 43, perspective, scene)}},
                .camera = perspective};
    const Values values = lens(4, 43, perspective);
    Image once = three_channels(run_effect("depth_of_field", input, values));
    for (float& value : input.color.values)
        value *= 2048;
    for (float& value : once.values)
        value *= 2048;
    CHECK(same_bits(three_channels(run_effect("depth_of_field", input, values)), once));
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
    CHECK(against_reference(input, values).absolute <= 4 * rounding);
    const Plan plan = plan_effect(
        "depth_of_field",
        Input{.color = Image(1280, 2160, 3), .attachments = input.attachments, .camera = perspective},
        values);
    // 216 px across: blocks of 18 px, so that the gather's radius stays 6 texels.
    CHECK(plan.passes.front().width == 72);
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
    const std::tuple<Input, Values, std::string> cases[] = {
        {input, {{"f_number", 128}}, "configuration"},
        {input, {{"max_circle_of_confusion", 0}}, "configuration"},
        {tele, {{"f_number", 8}, {"max_circle_of_confusion", 0.1}}, "scene"},
        {without_depth, {{"max_circle_of_confusion", 0.1}}, "scene"}};
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
