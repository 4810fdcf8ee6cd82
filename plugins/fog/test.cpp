#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr double ulp = 0x1p-23; // of 1
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr const char *classic = "classic", *medium = "medium"; // levels

/// At that height, looking up by `pitch` degrees. The matrix is rounded to float32, as the shader gets it, so
/// that its rounding is no error of the effect.
Camera placed(Camera camera, double height, double pitch) {
    const double c = static_cast<float>(std::cos(pitch * std::numbers::pi / 180));
    const double s = static_cast<float>(std::sin(pitch * std::numbers::pi / 180));
    camera.view_to_world = {1, 0, 0, 0, 0, c, s, 0, 0, -s, c, 0, 0, height, 0, 1};
    return camera;
}
/// Numbers that are exact in float32: tan(fov / 2) = 1, depth = 1 / (8 z).
Camera looking(double height, double pitch) {
    return placed(Camera::perspective(90, 0.125), height, pitch);
}
/// All rays of a row are alike but for where they lie beside the axis.
Camera looking_in_parallel(double height, double pitch) {
    return placed(Camera::parallel(1, 1, 4097), height, pitch);
}

/// Of the middle ray, per metre.
double rise_of(const Camera& camera) {
    return -camera.view_to_world[9];
}

/// Raw depth samples for distances along the view axis [m].
Image depth_of(int width, int height, const Camera& camera, const std::function<double(int, int)>& distance) {
    Image depth(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            depth.at(x, y, 0) = static_cast<float>(camera.depth_at(distance(x, y)));
    }
    return depth;
}

/// Light 1 in red and none in green, for fog that is green: the picture is (transmittance, opacity).
Input white(int width, int height, const Camera& camera, const std::function<double(int, int)>& distance) {
    return {.color = constant(width, height, {1, 0, 0}),
            .attachments = {{"depth", depth_of(width, height, camera, distance)}},
            .camera = camera};
}
Values green(Values values) {
    values.insert({{"color.0", 0}, {"color.1", 1}, {"color.2", 0}, {"sky", 1}});
    return values;
}

Image run(const Input& input, const Values& values) {
    return run_effect("fog", input, green(values));
}
double transmittance_of(const Camera& camera, double distance, const Values& values) {
    return run(white(1, 1, camera, [&](int, int) { return distance; }), values).at(0, 0, 0);
}

/// Error of the optical thickness against the reference, by what the picture has most digits of, relative;
/// and of the transmittance.
struct ThicknessError {
    double relative = 0, transmittance = 0;
};
ThicknessError thickness_error(const Image& result, const Image64& expected, int x, int y) {
    const double kept = expected.at(x, y, 0), opacity = expected.at(x, y, 1);
    const double difference = std::abs(result.at(x, y, 0) - kept);
    if (kept == 1) return {result.at(x, y, 0) == 1 ? 0.0 : infinity, difference};
    if (kept < 1e-30) return {0, difference}; // no light left
    const double thickness = kept > 0.5 ? -std::log1p(-opacity) : -std::log(kept);
    const double error = kept > 0.5 ? std::abs(result.at(x, y, 1) - opacity) / kept : difference / kept;
    return {error / thickness, difference};
}

double logarithmic(int i, int count, double first, double last) {
    return first * std::pow(last / first, double(i) / (count - 1));
}

} // namespace

TEST_CASE("optical thickness and transmittance are those of float64, from 0 to infinity") {
    // Level and vertical rays, so that rises are exact and what is measured is the fog alone.
    constexpr int count = 256;
    ThicknessError worst;
    for (double falloff : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 0.01, 0.08, 0.37, 1.0, 10.0}) {
        for (double pitch : {0.0, 90.0}) {
            for (double density : {1e-9, 1e-6, 0.003, 1.0}) {
                const Input input = white(1, count, looking_in_parallel(0, pitch), [](int, int y) {
                    return y == 0 ? double(infinity) : 1 + logarithmic(y, count, 1.0 / 64, 4096);
                });
                const Values values = {
                    {"height_falloff", falloff}, {"density", density}, {"base_height", -1}};
                const Image64 expected = reference(reference_input("fog", input, green(values)));
                const Image result = run(input, values);
                for (int y = 0; y < count; ++y) {
                    const ThicknessError error = thickness_error(result, expected, 0, y);
                    worst.relative = std::max(worst.relative, error.relative);
                    worst.transmittance = std::max(worst.transmittance, error.transmittance);
                }
            }
        }
    }
    CHECK(worst.relative <= 1e-6);
    CHECK(worst.transmittance <= 3e-7);
}

TEST_CASE("slanted rays are exact up to the rounding of heights") {
    constexpr int count = 96;
    double worst = 0;
    for (double falloff : {0.0, 1e-9, 1e-6, 1e-4, 0.01, 0.08, 0.37, 1.0, 10.0}) {
        for (double pitch : {-90.0, -41.0, -3.0, -1e-4, 1e-6, 2.0, 30.0, 90.0}) {
            for (double density : {1e-7, 0.003, 1.0}) {
                const Input input = white(1, count, looking(3, pitch), [&](int, int y) {
                    return y == 0 ? double(infinity) : logarithmic(y, count, 0.125, 1e7);
                });
                const Values values = {{"height_falloff", falloff}, {"density", density}, {"base_height", 1}};
                const Image64 expected = reference(reference_input("fog", input, green(values)));
                const Image result = run(input, values);
                for (int y = 0; y < count; ++y) {
                    // A height is only known to some ulp of the distance that it is reckoned from, and density
                    // changes by that times the falloff.
                    const double distance =
                        y == 0 ? 1 : 2 + 1.5 * input.camera.view_z(input.attachments.at("depth").at(0, y, 0));
                    const double margin = 1e-6 + falloff * distance * ulp;
                    worst = std::max(worst, thickness_error(result, expected, 0, y).relative / margin);
                }
            }
        }
    }
    CHECK(worst <= 1);
}

TEST_CASE("the reference is the integral of density along the ray") {
    for (double falloff : {0.0, 0.05, 0.3}) {
        for (double pitch : {-60.0, 0.0, 7.0}) {
            const Camera camera = looking(1.5, pitch);
            const Input input = white(1, 1, camera, [](int, int) { return 40; });
            const Values values = {
                {"height_falloff", falloff}, {"density", 0.001}, {"base_height", -3}, {"start", 10}};
            const double expected =
                -std::log(reference(reference_input("fog", input, green(values))).at(0, 0, 0));
            const double rise = rise_of(camera);
            double sum = 0;
            constexpr int steps = 100000;
            for (int i = 0; i < steps; ++i) {
                const double along = 10 + 30 * (i + 0.5) / steps;
                sum += 0.001 * std::exp(-falloff * (1.5 + rise * along + 3)) * 30 / steps;
            }
            CHECK(expected == Approx(sum).epsilon(1e-6)); // the midpoint rule with steps of 0.3 mm
        }
    }
}

TEST_CASE("the axis distance is its own model") {
    constexpr int count = 64;
    for (double falloff : {0.0, 1e-6, 0.01, 0.08}) {
        for (double pitch : {-20.0, 0.0, 1e-3, 30.0}) {
            const Camera camera = looking(3, pitch);
            const Input input = white(1, count, camera, [&](int, int y) {
                return y == 0 ? double(infinity) : logarithmic(y, count, 0.125, 400);
            });
            const Values values = {{"height_falloff", falloff}, {"density", 0.01}, {"quality", classic}};
            const Image64 expected = reference(reference_input("fog", input, green(values)));
            const Image result = run(input, values);
            double worst = 0;
            for (int y = 0; y < count; ++y)
                worst = std::max(worst, thickness_error(result, expected, 0, y).relative);
            CHECK(worst <= 1e-6);
        }
    }
}

TEST_CASE("fog of two stretches is the product of both") {
    for (double falloff : {0.0, 0.03, 0.5}) {
        for (double pitch : {-30.0, 0.0, 30.0}) {
            for (double middle : {0.5, 7.0, 63.0}) {
                const Camera camera = looking(2, pitch);
                const Values all = {{"height_falloff", falloff}, {"density", 0.02}};
                Values second = all;
                second["start"] = middle;
                const double whole = transmittance_of(camera, 64, all);
                const double product =
                    transmittance_of(camera, middle, all) * transmittance_of(camera, 64, second);
                CHECK(std::abs(whole - product) <= 4 * ulp);
            }
        }
    }
}

TEST_CASE("seen from the other end, the fog is the same") {
    for (double falloff : {0.0, 1e-4, 0.03, 0.5}) {
        for (double pitch : {0.0, 1e-3, 5.0, 60.0, 90.0}) {
            for (double distance : {0.25, 30.0, 500.0}) {
                const Camera below = looking(2, pitch);
                const Camera above = looking(2 + rise_of(below) * distance, -pitch);
                const Values values = {{"height_falloff", falloff}, {"density", 0.01}};
                CHECK(std::abs(transmittance_of(below, distance, values)
                               - transmittance_of(above, distance, values))
                      <= 4 * ulp);
            }
        }
    }
}

TEST_CASE("turning the camera does not change the fog before a point, but for the axis distance") {
    constexpr int count = 33;
    const double elevation = 4, distance = 80;
    for (const char* level : {medium, classic}) {
        double least = 1, most = 0;
        for (int y = 0; y < count; y += 4) {
            const double angle = std::atan((2 * y + 1.0 - count) / count) * 180 / std::numbers::pi;
            const Camera camera = looking(5, elevation - angle);
            const Input input = white(1, count, camera, [&](int, int) {
                return distance * std::cos(angle * std::numbers::pi / 180);
            });
            const double found =
                run(input, {{"height_falloff", 0.05}, {"density", 0.01}, {"quality", level}}).at(0, y, 0);
            least = std::min(least, found);
            most = std::max(most, found);
        }
        if (level == classic) {
            // At the edge, 44 degrees off the axis, the distance is short by 29 %.
            CHECK(most == Approx(std::exp(-0.8 * std::cos(std::atan(32.0 / 33)))).margin(1e-6));
            CHECK(least == Approx(std::exp(-0.8)).margin(1e-6));
        } else {
            CHECK(most - least <= 4e-7); // the matrices' rounding and twice 1e-6 of the thickness 0.6
        }
    }
}

TEST_CASE("more distance or more density never means less fog") {
    constexpr int count = 2000;
    for (double pitch : {-20.0, 0.0, 20.0}) {
        Input input = white(count, 1, looking_in_parallel(2, pitch), [](int x, int) { return 1 + 0.25 * x; });
        Image before = input.color;
        for (double density : {1e-6, 1e-4, 0.01, 0.02, 0.1, 1.0}) {
            const Image result = run(input, {{"height_falloff", 0.1}, {"density", density}});
            double rises = 0, thins = 0;
            for (int x = 0; x < count; ++x) {
                if (x > 0) rises = std::max(rises, double(result.at(x, 0, 0)) - result.at(x - 1, 0, 0));
                thins = std::max(thins, double(result.at(x, 0, 0)) - before.at(x, 0, 0));
            }
            CHECK(rises <= 2 * ulp); // rounding where the series gives way to the exponential
            CHECK(thins <= 2 * ulp);
            before = result;
        }
    }
}

TEST_CASE("the sky is what infinitely far points look like") {
    for (double falloff : {0.001, 0.08, 5.0}) {
        for (double pitch : {-10.0, 0.0, 0.5, 20.0, 90.0}) {
            const Camera camera = looking(3, pitch);
            const Values values = {{"height_falloff", falloff}, {"density", 0.0005}};
            const double sky = transmittance_of(camera, infinity, values);
            CHECK(sky == Approx(transmittance_of(camera, 1e12, values)).margin(1e-6));
            if (pitch <= 0) CHECK(sky == 0);
        }
    }
    const Camera camera = looking(3, 20);
    CHECK(transmittance_of(camera, infinity, {{"height_falloff", 0}, {"density", 1e-9}}) == 0);
    CHECK(transmittance_of(camera, infinity, {{"height_falloff", 0}, {"quality", classic}}) == 0);
    for (const char* level : {classic, medium}) {
        CHECK(transmittance_of(camera, infinity, {{"sky", 0}, {"quality", level}}) == 1);
        CHECK(transmittance_of(camera, 1e9, {{"height_falloff", 0}, {"sky", 0}, {"quality", level}}) == 0);
    }
}

TEST_CASE("opacity stops at its maximum and distance begins at the start") {
    const Camera camera = looking(0, 0);
    CHECK(transmittance_of(camera, 1e6, {{"height_falloff", 0}, {"max_opacity", 0.75}}) == 0.25);
    CHECK(transmittance_of(camera, infinity, {{"height_falloff", 0}, {"max_opacity", 0.75}}) == 0.25);
    CHECK(transmittance_of(camera, 10, {{"start", 10}}) == 1);
    CHECK(transmittance_of(camera, 11, {{"start", 10}, {"density", 0.5}, {"height_falloff", 0}})
          == Approx(std::exp(-0.5)).margin(ulp));
    // Near planes of parallel rays are where their fog begins.
    CHECK(transmittance_of(looking_in_parallel(0, 0), 3, {{"density", 0.5}, {"height_falloff", 0}})
          == Approx(std::exp(-1)).margin(ulp));
}

TEST_CASE("a camera at a large height above a base as large sees what one at 0 does") {
    const Values near_ground = {{"density", 0.01}, {"base_height", -2}};
    const Values high = {{"density", 0.01}, {"base_height", 65534}};
    CHECK(transmittance_of(looking(0, 5), 100, near_ground)
          == transmittance_of(looking(65536, 5), 100, high));
}

TEST_CASE("no density, no opacity or no depth change no bit, and neither does no distance") {
    Input input = white(33, 17, looking(1, 0), [](int, int) { return 0.5; });
    input.color = noise(33, 17, -5, 60);
    input.color.at(0, 0, 0) = -0.0f;
    input.color.at(1, 0, 1) = infinity;
    const std::uint32_t payload = 0x7fc12345u;
    std::memcpy(&input.color.at(2, 0, 2), &payload, sizeof(payload));
    for (const char* level : {classic, medium}) {
        for (Values values : {Values{{"density", 0}}, Values{{"max_opacity", 0}}}) {
            values["quality"] = level;
            CHECK(same_bits(run_effect("fog", input, values), input.color));
            const Plan plan = plan_effect("fog", input, values);
            CHECK(plan.passes.empty());
            CHECK(plan.effects.at(0).moment == Moment::configuration);
            CHECK(plan.effects.at(0).kind == SkipKind::exact);
        }
        CHECK(same_bits(run_effect("fog", input, {{"start", 2}, {"quality", level}}), input.color));
    }
    Input no_depth{.color = input.color};
    CHECK(same_bits(run_effect("fog", no_depth, {}), input.color));
    CHECK(plan_effect("fog", no_depth, {}).effects.at(0).moment == Moment::scene);
}

TEST_CASE("hostile pixels stay where they are, and opaque fog hides what is infinite") {
    Input input = white(33, 33, looking(1, 0), [](int x, int) { return x < 16 ? 10.0 : 1e9; });
    input.color = constant(33, 33, {65504, -65504, 1e-40f});
    const float hostile[] = {infinity, -infinity, not_a_number};
    for (int i = 0; i < 3; ++i) {
        input.color.at(i, 8, 0) = hostile[i];
        input.color.at(20 + i, 8, 0) = hostile[i];
    }
    for (const char* level : {classic, medium}) {
        const Image result = run_effect(
            "fog", input, {{"quality", level}, {"height_falloff", 0}, {"density", 1}, {"color.0", 0.5}});
        int non_finite = 0;
        for (float value : result.values)
            non_finite += !std::isfinite(value);
        CHECK(non_finite == 3);
        CHECK(result.at(0, 8, 0) == infinity);
        CHECK(result.at(20, 8, 0) == 0.5f);
    }
}

TEST_CASE("finite light stays finite whatever depth, camera and values") {
    const float samples[] = {0,        1,         -1,    2,     0.5f, 1e-30f, 1e-40f, not_a_number,
                             infinity, -infinity, 3e38f, -3e38f};
    std::mt19937 random(7);
    const auto any = [&](double most) { // often an end
        const double u = std::uniform_real_distribution(-0.2, 1.2)(random);
        return most * std::pow(std::clamp(u, 0.0, 1.0), 4);
    };
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 13}, std::pair{16, 9}}) {
        Input input{.color = noise(width, height, 0, 65504)};
        Image depth(width, height, 1);
        for (std::size_t i = 0; i < depth.values.size(); ++i)
            depth.values[i] = samples[i % std::size(samples)];
        input.attachments["depth"] = depth;
        for (int run = 0; run < 40; ++run) {
            const double up = std::uniform_real_distribution(-90.0, 90.0)(random);
            const double at = any(1) * (run % 2 == 0 ? 1e5 : -1e5);
            const Camera cameras[] = {
                looking(at, up), looking_in_parallel(at, up),
                placed(Camera::perspective(179, 1e-3, 1e7, Camera::DepthKind::standard), at, 0)};
            input.camera = cameras[run % 3];
            const Values values = {{"quality", run / 3 % 2 == 0 ? classic : medium},
                                   {"density", any(1)},
                                   {"height_falloff", any(10)},
                                   {"base_height", -at},
                                   {"start", any(1e6)},
                                   {"max_opacity", any(1)},
                                   {"color.0", any(1000)},
                                   {"sky", run % 2}};
            const Image result = run_effect("fog", input, values, Format::rgba16f);
            CHECK(std::all_of(result.values.begin(), result.values.end(),
                              [](float value) { return std::isfinite(value); }));
        }
    }
}

TEST_CASE("with a shifted lens fog is that of the part of a larger picture") {
    constexpr int width = 96, height = 54;
    const auto distance = [](int x, int y) { return y > 44 ? double(infinity) : 3 + 0.4 * x + 0.2 * y; };
    for (const Camera& camera :
         {looking(2, 10), placed(Camera::perspective(50, 0.1), 2, -20), looking_in_parallel(2, 20)}) {
        const Input whole = white(width, height, camera, distance);
        for (const Values& more : {Values{}, Values{{"start", 12}}, Values{{"quality", classic}}}) {
            Values values = green({{"density", 0.02}, {"height_falloff", 0.3}});
            values.insert(more.begin(), more.end());
            const Image wide = run_effect("fog", whole, values);
            for (const Part& part : {Part{48, 0, 48, 54}, Part{0, 27, 96, 27}, Part{5, 9, 31, 23}}) {
                const Input input = part_of(whole, part);
                const Image result = run_effect("fog", input, values);
                // The bound of slanted rays, at a falloff of 0.3 and up to 70 m: 1e-6 + 0.3 * 107 * ulp = 5e-6 of a
                // thickness, which moves the light by 0.4 of that at most; for either picture.
                CHECK(worst_difference(result, convert<double>(part_of(three_channels(wide), part))).absolute
                      <= 4e-6);
                CHECK(worst_difference(result, reference(reference_input("fog", input, values))).absolute
                      <= 4e-6);
            }
        }
    }
}

TEST_CASE("the longest ray is the one to the corner that is farthest from the axis") {
    // Nothing lies beyond 10 m along the view axis, but rays to the right are longer by sqrt(1 + 1 + 9).
    Input input = white(9, 9, looking(0, 0), [](int, int) { return 10; });
    input.camera.principal_point = {-2, 0};
    const Values values = {{"start", 25}, {"density", 0.1}, {"sky", 0}};
    const Image fogged = run_effect("fog", input, green(values));
    CHECK(fogged.at(8, 8, 1) > 0.1f);
    CHECK(fogged.at(0, 4, 1) == 0);
    Values all = green(values);
    all["skip"] = "nothing";
    CHECK(same_bits(fogged, run_effect("fog", input, all)));
}
