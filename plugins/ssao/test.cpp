#include "test_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

using namespace postfx;
using namespace postfx::testing;

TEST_CASE("every level approximates the float64 reference, better from level to level") {
    // Root mean square over the picture: what few samples of the horizon miss, and, below `high`, what a texel
    // for several pixels can't show. `reference` differs by 24 slices for 64 and by the gaps of 64 samples.
    constexpr std::array bounds = {0.07, 0.07, 0.05, 0.027, 0.008};
    std::array<double, 5> sums{};
    for (const Camera& camera : {perspective, parallel}) {
        for (const bool with_normals : {true, false}) {
            for (const auto& [radius, falloff] : {std::pair{0.5, 0.6}, std::pair{1.5, 0.2}}) {
                const Input input = seen(room, 120, 90, camera, with_normals);
                const Values more = {{"radius", radius}, {"falloff", falloff}};
                const Image64 expected = reference(reference_input("ssao", input, at(best, more)));
                for (const Level level : approximations) {
                    const double error = root_mean_square(visibility(input, level, more), expected);
                    INFO("level " << level << (camera.orthographic ? " parallel" : " perspective")
                                  << (with_normals ? "" : " without normals") << ", radius " << radius);
                    CHECK(error <= bounds[static_cast<std::size_t>(level)]);
                    sums[static_cast<std::size_t>(level)] += error;
                }
            }
        }
    }
    CHECK(sums[medium] < sums[low]);
    CHECK(sums[high] < sums[medium]);
    CHECK(sums[ultra] < sums[high]);
    CHECK(sums[best] < sums[ultra]);
}

TEST_CASE("classic counts as its float64 model counts") {
    for (const auto& [width, height] : {std::pair{120, 90}, std::pair{33, 500}}) {
        const Input input = seen(room, width, height, perspective);
        const Image result = visibility(input, classic);
        const Image64 expected = reference(reference_input("ssao", input, at(classic)));
        const Worst worst = worst_difference(result, expected);
        // Two distances may round to the same float, or to both sides of the radius.
        CHECK(worst.absolute <= 2.0 / 80 + 1e-6);
        CHECK(root_mean_square(result, expected) <= 0.001);
    }
    // What is wrong with it: half of a slope's neighbours are nearer.
    const Input slope = seen(plane({0, 0, -5}, {0, std::sin(1.0), std::cos(1.0)}), 60, 60, parallel);
    CHECK(visibility(slope, classic).at(30, 30, 0) < 0.6f);
}

TEST_CASE("only the ambient share is darkened") {
    const Input input = seen(room, 97, 61, perspective);
    for (const Level level : {low, medium, high, classic}) {
        const Image visible = visibility(input, level);
        const Image result = run_effect("ssao", input, {{"quality", level}, {"strength", 0.75}});
        Image64 expected = convert<double>(input.color);
        for (int y = 0; y < expected.height; ++y) {
            for (int x = 0; x < expected.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    expected.at(x, y, c) -=
                        0.75 * (1.0 - visible.at(x, y, c)) * input.attachments.at("ambient").at(x, y, c);
                }
            }
        }
        CHECK(worst_difference(result, expected).absolute <= 1e-6); // three roundings of values below 4
    }
}

TEST_CASE("without an ambient share nothing is darkened, unless all light is to count") {
    Input input = seen(room, 40, 30, perspective);
    input.attachments.erase("ambient");
    const Plan plan = plan_effect("ssao", input);
    CHECK(plan.passes.empty());
    CHECK(plan.effects[0].status == EffectStatus::skipped);
    CHECK(plan.effects[0].moment == Moment::scene);
    const Image visible = visibility(input, medium);
    const Image result = run_effect("ssao", input, {{"without_ambient", 1}});
    Image64 expected = convert<double>(input.color);
    for (int i = 0; i < 40 * 30 * 3; ++i)
        expected.values[static_cast<std::size_t>(i)] *= visible.at(i / 3 % 40, i / 120, i % 3);
    CHECK(worst_difference(result, expected).absolute <= 1e-6);
}

TEST_CASE("a plane is not occluded, however it is tilted") {
    for (const Camera& camera : {perspective, parallel}) {
        for (const bool with_normals : {true, false}) {
            for (const double degrees : {0, 20, 45, 60, 75, 85}) {
                for (const double distance : {0.5, 5.0, 3000.0}) {
                    if (camera.orthographic && distance > 5) continue; // beyond the far plane
                    const double tilt = degrees * std::numbers::pi / 180;
                    const Vector normal = {0.6 * std::sin(tilt), -0.8 * std::sin(tilt), std::cos(tilt)};
                    const Input input = seen(plane({0, 0, -distance}, normal), 64, 48, camera, with_normals);
                    for (const Level level : approximations) {
                        INFO(degrees << " degrees, " << distance << " m, level " << level << ", normals "
                                     << with_normals << " orthographic " << camera.orthographic);
                        CHECK(least(visibility(input, level, {{"radius", 0.3 * distance}})) >= 254.0 / 255);
                    }
                }
            }
        }
    }
}

TEST_CASE("a wall at a right angle occludes as in closed form") {
    for (const Camera& camera : {perspective, Camera::parallel(4, 0.1, 100)}) {
        const int size = 128;
        const double radius = 0.8;
        const Input input = seen(valley, size, size, camera);
        const Image result = visibility(input, best, {{"radius", radius}, {"falloff", 0}});
        double sum = 0;
        int count = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = size / 4; x < 3 * size / 4;
                 ++x) { // away from the border, beyond which no wall is known
                const Ray ray = ray_of(camera, size, size, x, y);
                const double height = ray.origin[1] + valley(ray).z * ray.step[1];
                if (std::abs(height) > 1.2) continue;
                const double k = std::min(1.0, std::abs(height) / diagonal / radius);
                const double expected = (std::acos(k) - k * std::sqrt(1 - k * k)) / std::numbers::pi;
                sum += std::pow(1 - result.at(x, y, 0) - expected, 2);
                ++count;
            }
        }
        INFO((camera.orthographic ? "orthographic" : "perspective"));
        UNSCOPED_INFO("error " << std::sqrt(sum / count));
        // A texel is 0.04 of the radius here, and what it hides decides at the foot and at the end.
        CHECK(std::sqrt(sum / count) <= 0.015);
    }
}

TEST_CASE("everywhere in a spherical bowl the same share is occluded, half its depth over its radius") {
    for (const double depth : {0.3, 0.6, 0.9}) {
        const double a = 1, rim = std::sqrt(a * a - (a - depth) * (a - depth));
        const Surface bowl = [&](const Ray& ray) {
            const bool inside = std::hypot(ray.origin[0], ray.origin[1]) < rim;
            // The rim lies 5 m away, the sphere's centre above it.
            return inside ? sphere({0, 0, -5 + a - depth}, a, true)(ray) : plane({0, 0, -5}, {0, 0, 1})(ray);
        };
        const int size = 160;
        const Input input = seen(bowl, size, size, Camera::parallel(2.4, 0.1, 100));
        const Image result = visibility(input, best, {{"radius", 100}, {"falloff", 0}});
        for (const double place : {0.0, 0.3, 0.6}) {
            const int x = static_cast<int>(size * (0.5 + place * rim / 2.4));
            INFO("depth " << depth << " at " << place << " of the rim");
            // The horizon is known to a pixel, which is 1.5 % of the bowl's radius.
            CHECK(1 - result.at(x, size / 2, 0) == Approx(depth / (2 * a)).margin(0.02));
        }
    }
}

TEST_CASE("a pit occludes its middle as in closed form, and more with a larger radius") {
    const double a = 0.5;
    for (const double depth : {0.25, 0.5, 1.0}) {
        const Surface pit = [&](const Ray& ray) {
            return Hit{std::hypot(ray.origin[0], ray.origin[1]) < a ? 5 + depth : 5, {0, 0, 1}};
        };
        const int size = 129;
        const Input input = seen(pit, size, size, Camera::parallel(2, 0.1, 100));
        const Image result = visibility(input, best, {{"radius", 100}, {"falloff", 0}});
        INFO("depth " << depth);
        // The wall stands within a pixel of where it should, 3 % of the pit's radius.
        CHECK(result.at(64, 64, 0) == Approx(a * a / (a * a + depth * depth)).margin(0.03));
        for (const Level level : approximations) {
            double before = 2;
            for (const double radius : {0.3, 0.5, 0.7, 1.0, 2.0}) {
                const double now = visibility(input, level, {{"radius", radius}}).at(64, 64, 0);
                CHECK(now <= before + 0.01); // samples move with the radius
                before = now;
            }
            CHECK(before < 0.9);
        }
    }
}

TEST_CASE("what is convex is not occluded") {
    const Input input = seen(sphere({0, 0, -5}, 1.5), 96, 96, perspective);
    for (const Level level : approximations)
        CHECK(least(visibility(input, level, {{"radius", 3}})) >= 254.0 / 255);
}

TEST_CASE("sky, and a plane across the view, keep the picture's bits") {
    for (const Camera& camera :
         {perspective, parallel, Camera::perspective(50, 0.1, 1e6, Camera::DepthKind::standard)}) {
        for (const double z : {nowhere, 5.0}) {
            Input input = seen([&](const Ray&) { return Hit{z, {0, 0, 1}}; }, 50, 34, camera);
            for (const Level level : {low, medium, high, ultra, best, classic})
                CHECK(same_bits(run_effect("ssao", input, {{"quality", level}}), input.color));
        }
        const Input input = seen(room, 80, 60, camera);
        for (const Level level : {low, medium, high, classic}) {
            const Image result = visibility(input, level);
            for (int y = 0; y < 60; ++y) {
                for (int x = 0; x < 80; ++x) {
                    const bool sky = room(ray_of(camera, 80, 60, x, y)).z == nowhere;
                    if (sky && result.at(x, y, 0) != 1) FAIL("sky is occluded at " << x << "," << y);
                }
            }
        }
    }
}

TEST_CASE("a mirrored scene is occluded as in a mirror") {
    // The reference has no pattern over pixels; the others' patterns are not mirrored, only their means.
    constexpr std::array bounds = {0.05, 0.04, 0.02, 0.012, 0.002};
    Input input = seen(room, 96, 72, perspective);
    Input mirror = input;
    for (const char* name : {"depth", "normal", "ambient"})
        mirror.attachments[name] = mirrored(input.attachments[name]);
    for (float* x = mirror.attachments["normal"].values.data();
         x < mirror.attachments["normal"].values.data() + mirror.attachments["normal"].values.size();
         x += 3) {
        *x = -*x;
    }
    for (const Level level : approximations) {
        const Image there = visibility(input, level);
        const Image back = mirrored(visibility(mirror, level));
        INFO("level " << level);
        CHECK(root_mean_square(back, convert<double>(there)) <= bounds[static_cast<std::size_t>(level)]);
    }
}

TEST_CASE("a scene of twice the size and twice the radius gives the same bits") {
    const Input input = seen(room, 80, 60, perspective);
    for (const double factor : {1.0 / 64, 2.0, 256.0}) {
        Input scaled = input;
        scaled.camera = Camera::perspective(50, 0.1 * factor); // the same depth samples
        for (const Level level : {low, medium, high, classic}) {
            CHECK(same_bits(visibility(scaled, level, {{"radius", factor}}), visibility(input, level)));
        }
    }
}

TEST_CASE("every depth convention gives the same picture") {
    const Image64 expected =
        convert<double>(three_channels(visibility(seen(room, 80, 60, perspective), high)));
    for (const Camera& camera : {Camera::perspective(50, 0.1, 100, Camera::DepthKind::reversed),
                                 Camera::perspective(50, 0.1, 100, Camera::DepthKind::standard),
                                 Camera::perspective(50, 0.5, 1e7, Camera::DepthKind::standard)}) {
        const Image result = visibility(seen(room, 80, 60, camera), high);
        CHECK(root_mean_square(result, expected) <= 1e-3); // the standard convention's steps near 1
    }
}

TEST_CASE("far away, where depth is coarser than the radius, occlusion fades instead of growing spots") {
    const Camera camera = Camera::perspective(50, 0.1, 1e6, Camera::DepthKind::standard);
    for (const double distance : {100.0, 1000.0, 10000.0}) {
        const Input input = seen(plane({0, 0, -distance}, {0, 0.6, 0.8}), 64, 48, camera);
        for (const Level level : approximations) {
            INFO(distance << " m, level " << level);
            CHECK(least(visibility(input, level, {{"radius", 0.1 * distance}})) >= 254.0 / 255);
        }
    }
}

TEST_CASE("hostile depth and normals give finite light") {
    const float depths[] = {0, 1, not_a_number, infinity, -infinity, -1, 1e-42f, 3e38f};
    const float normals[] = {0, 1e-42f, not_a_number, infinity, 1e30f};
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 9}, std::pair{2, 2}, std::pair{3, 1},
                                        std::pair{41, 33}, std::pair{8000, 2}}) {
        for (const bool with_normals : {true, false}) {
            Input input = seen(room, width, height, perspective, with_normals);
            Image& depth = input.attachments["depth"];
            for (std::size_t i = 0; i < depth.values.size(); i += 3)
                depth.values[i] = depths[i / 3 % std::size(depths)];
            if (with_normals) {
                Image& normal = input.attachments["normal"];
                for (std::size_t i = 0; i < normal.values.size(); i += 7)
                    normal.values[i] = normals[i / 7 % std::size(normals)];
            }
            for (const Camera& camera : {perspective, parallel, Camera::perspective(90, 1e-6)}) {
                input.camera = camera;
                for (const double radius : {1e-3, 1.0, 1000.0}) {
                    for (const Level level : {low, medium, high, ultra, classic}) {
                        if (level == ultra && width > 1000)
                            continue; // for time; its shaders are those of high
                        INFO(width << "x" << height << " level " << level << " radius " << radius);
                        const Image result =
                            run_effect("ssao", input, {{"quality", level}, {"radius", radius}});
                        CHECK(all_finite(result));
                        CHECK(least(result) >= 0);
                    }
                }
            }
        }
    }
}

TEST_CASE("unusable normals leave their pixels open") {
    Input input = seen(room, 60, 40, perspective);
    for (const float value : {0.0f, not_a_number, infinity, 1e-42f}) {
        input.attachments["normal"] = constant(60, 40, {value, value, value});
        for (const Level level : {low, medium, high, best, classic})
            CHECK(same_bits(run_effect("ssao", input, {{"quality", level}}), input.color));
    }
}

TEST_CASE("single unusable normals leave their pixels open and darken or lighten no other") {
    const Input clean = seen(room, 60, 40, perspective);
    for (const float value : {0.0f, not_a_number, infinity, 1e-42f}) {
        Input input = clean;
        const auto is_spot = [](int x, int y) { return x % 7 == 3 && y % 6 == 2; };
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 60; ++x) {
                for (int c = 0; is_spot(x, y) && c < 3; ++c)
                    input.attachments["normal"].at(x, y, c) = value;
            }
        }
        for (const Level level : {low, medium, high, ultra, best, classic}) {
            const Image expected = visibility(clean, level), result = visibility(input, level);
            double spots = 1, sum = 0, expected_sum = 0;
            for (int y = 0; y < 40; ++y) {
                for (int x = 0; x < 60; ++x) {
                    if (is_spot(x, y)) {
                        spots = std::min(spots, double(result.at(x, y, 0)));
                    } else {
                        sum += 1 - result.at(x, y, 0);
                        expected_sum += 1 - expected.at(x, y, 0);
                    }
                }
            }
            INFO("normals of " << value << ", level " << level);
            CHECK(spots == 1);
            // Neighbours stand in for the texels that are left out, a twentieth in `medium`, be they darker or lighter;
            // counted as open these would take 2 to 8 % of the occlusion.
            CHECK(sum >= 0.99 * expected_sum);
            CHECK(sum <= 1.05 * expected_sum);
        }
    }
}

TEST_CASE("hostile light stays in its pixel") {
    Input input = seen(room, 60, 40, perspective);
    const Image clean = run_effect("ssao", input);
    const float hostile[] = {not_a_number, infinity, -infinity, -3, -0.0f, 1e-42f, 65504};
    for (int i = 0; i < 7; ++i) {
        input.color.at(8 * i, 11, i % 3) = hostile[i];
        input.attachments["ambient"].at(8 * i, 25, i % 3) = hostile[i];
    }
    const Image result = run_effect("ssao", input);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 60; ++x) {
            for (int c = 0; c < 3; ++c) {
                const bool touched = x % 8 == 0 && (y == 11 || y == 25);
                if (!touched) CHECK(result.at(x, y, c) == clean.at(x, y, c));
                if (std::isfinite(input.color.at(x, y, c))) CHECK(std::isfinite(result.at(x, y, c)));
            }
        }
    }
}

TEST_CASE("without cause the effect does not run, and the picture keeps its bits") {
    Input input = seen(room, 20, 10, perspective);
    input.color.at(3, 3, 0) = -0.0f;
    const std::uint32_t payload = 0x7fc01234u;
    std::memcpy(&input.color.at(4, 4, 1), &payload, sizeof payload);
    Input flat = input;
    flat.attachments.erase("depth");
    // 1 mm at the near plane of 0.1 m is 0.1 pixels of 10: not seen, so skipped where that is allowed.
    const std::tuple<Input, Values, Moment> cases[] = {
        {input, {{"strength", 0}}, Moment::configuration},
        {input, {{"radius", 0}}, Moment::configuration},
        {input, {{"radius", 0.001}, {"skip", "visible"}}, Moment::scene},
        {flat, {}, Moment::scene}};
    for (const auto& [given, values, moment] : cases) {
        const Plan plan = plan_effect("ssao", given, values);
        CHECK(plan.passes.empty());
        REQUIRE(plan.effects.size() == 1);
        CHECK(plan.effects[0].status == EffectStatus::skipped);
        CHECK(plan.effects[0].moment == moment);
        CHECK(same_bits(run_effect("ssao", given, values), given.color));
    }
}

TEST_CASE("the same input gives the same bits") {
    const Input input = seen(room, 61, 47, perspective, false);
    for (const Level level : {low, medium, high, classic})
        CHECK(same_bits(visibility(input, level), visibility(input, level)));
}

TEST_CASE("with a shifted lens occlusion is that of the part of a larger picture") {
    // The part begins at a multiple of 3x3 texels, the slices' pattern, in blocks of 3, 2 and 1 pixels.
    constexpr int width = 240, height = 120;
    constexpr Part part = {.x = 126, .y = 0, .width = 114, .height = 120};
    for (const Camera& camera : {perspective, parallel}) {
        for (const bool with_normals : {true, false}) {
            const Input whole = seen(room, width, height, camera, with_normals);
            const Input input = part_of(whole, part);
            Input centred = input;
            centred.camera.principal_point = {0, 0};
            for (const Level level : approximations) {
                const Values more = {{"radius", 0.3}};
                const Image wide = part_of(visibility(whole, level, more), part);
                const Image result = visibility(input, level, more), wrong = visibility(centred, level, more);
                // Less than 0.3 m before the new border, which is 16 px at the nearest surface (and the pixels that
                // denoising and its neighbours add), what lies beyond it is missing.
                double worst = 0, sum = 0, wrong_sum = 0;
                for (int y = 0; y < part.height; ++y) {
                    for (int x = 30; x < part.width; ++x) {
                        const double difference = std::abs(result.at(x, y, 0) - wide.at(x, y, 0));
                        worst = std::max(worst, difference);
                        sum += difference;
                        wrong_sum += std::abs(wrong.at(x, y, 0) - wide.at(x, y, 0));
                    }
                }
                INFO("level " << level << (camera.orthographic ? " parallel" : " perspective")
                              << (with_normals ? "" : " without normals"));
                // A place that is rounded differently may fall into the next pixel, which changes one of a slice's
                // two horizons; seldom.
                CHECK(worst <= 0.2);
                CHECK(sum / ((part.width - 30) * part.height) <= 1e-4);
                if (!camera.orthographic) CHECK(wrong_sum > 20 * sum);
            }
        }
    }
}

TEST_CASE("every level approximates the float64 reference with a shifted lens") {
    Camera camera = perspective;
    camera.principal_point = {-0.8, 0.3};
    for (const bool with_normals : {true, false}) {
        const Input input = seen(room, 120, 90, camera, with_normals);
        const Values more = {{"radius", 0.5}};
        const Image64 expected = reference(reference_input("ssao", input, at(best, more)));
        // As with the axis in the middle.
        CHECK(root_mean_square(visibility(input, best, more), expected) <= 0.008);
        CHECK(root_mean_square(visibility(input, medium, more), expected) <= 0.07);
    }
}
