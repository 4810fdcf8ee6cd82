// What holds for any light and depth, whatever the level.
#include "test_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr int all_levels[] = {low, medium, ultra, reference_level, classic};
/// Sums of up to 256 weighted samples in float32, in another order.
constexpr double rounding = 1e-5;

/// Whole tiles of every level: blocks of a pixel in tiles of 16 texels (low: 2 pixels, 8 texels).
constexpr int size = 112;
/// Circles of at most 11.2 px, for blocks of 2 pixels in the level low too.
Values small_lens(int level, double diameter = 10) {
    return lens(diameter, size, perspective, level);
}

/// Near, sharp and far by turns.
double layered(int x, int y) {
    if (x > 30 && x < 37) return distance_with(-0.9);
    return std::hypot(x - 60, y - 50) < 17 ? 4.0 : distance_with(0.02 * y - 0.9);
}

Image64 doubled_precision(const Image& image) {
    return convert<double>(three_channels(image));
}

Image run(int level, const Image& color, const std::function<double(int, int)>& distance,
          double diameter = 10) {
    return run_effect("depth_of_field", scene(color, distance), small_lens(level, diameter));
}

/// Moments of one channel about a place.
struct Spread {
    double energy = 0, variance = 0; ///< an axis, pixels^2
};
Spread spread_of(const Image& image, int channel, double x0, double y0) {
    Spread result;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double light = image.at(x, y, channel);
            result.energy += light;
            result.variance += light * (std::pow(x - x0, 2) + std::pow(y - y0, 2)) / 2;
        }
    }
    result.variance /= result.energy;
    return result;
}

} // namespace

TEST_CASE("a mirrored scene gives the mirrored picture") {
    const Image color = noise(size, size, 0, 4);
    for (int level : all_levels) { // in another order of sums
        const Image there = run(level, color, layered);
        const Image back = run(level, mirrored(color), [](int x, int y) { return layered(size - 1 - x, y); });
        INFO(level_names[level]);
        CHECK(worst_difference(mirrored(back), doubled_precision(there)).absolute <= 4 * rounding);
    }
}

TEST_CASE("a moved scene gives the moved picture") {
    constexpr int moved = 16; // whole tiles
    const Image patch = noise(32, 32, 0, 4);
    const auto at = [&](int by) {
        Image color = constant(size, size, {0.5f, 0.5f, 0.5f});
        for (int y = 0; y < 32; ++y)
            std::copy_n(patch.pixel(0, y), 32 * 3, color.pixel(24 + by, 30 + by + y));
        return color;
    };
    const auto depth = [](int by) {
        return [by](int x, int y) {
            const double c = std::hypot(x - by - 40, y - by - 46) < 13 ? -0.9 : 0.7;
            return distance_with(c);
        };
    };
    for (int level : all_levels) {
        const Image still = run(level, at(0), depth(0)), after = run(level, at(moved), depth(moved));
        Image back = still;
        for (int y = 0; y < size - moved; ++y)
            std::copy_n(after.pixel(moved, y + moved), (size - moved) * 4, back.pixel(0, y));
        INFO(level_names[level]);
        // The last rows and columns would show what was beyond the picture: constant in both.
        // The place between two texels is rounded by the filter.
        CHECK(worst_difference(back, doubled_precision(still)).absolute <= 4 * rounding);
    }
}

TEST_CASE("light is scaled by powers of two bit for bit, and adds up") {
    const Image color = noise(71, 43, -1, 8), other = noise(71, 43, 0, 3, 7);
    const auto distance = [](int x, int y) { return distance_with(0.04 * x - 0.05 * y - 0.9); };
    for (int level : all_levels) {
        INFO(level_names[level]);
        const Image once = three_channels(run(level, color, distance));
        for (float factor : {2048.0f, 1.0f / 4096}) {
            const Image result = run(level, scaled(color, factor), distance);
            CHECK(same_bits(three_channels(result), scaled(once, factor)));
        }
        Image together = color;
        for (std::size_t i = 0; i < together.values.size(); ++i)
            together.values[i] += other.values[i];
        Image64 sum = doubled_precision(once);
        const Image64 second = doubled_precision(run(level, other, distance));
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += second.values[i];
        CHECK(worst_difference(run(level, together, distance), sum).absolute <= 11 * rounding);
    }
}

TEST_CASE("constant light stays constant whatever the depth") {
    for (const auto& [width, height] :
         {std::pair{1, 1}, std::pair{70, 51}, std::pair{1, 64}, std::pair{200, 3}}) {
        Image depth = noise(width, height, 0, 1);
        for (float& value : depth.values)
            value = value * value * value;
        depth.channels = 1; // its first third
        depth.values.resize(depth.pixel_count());
        for (int level : all_levels) {
            for (double axial : {0.0, 0.01}) {
                for (float light : {0.0f, 6.1e-5f, 65504.0f}) {
                    const Input input{.color = constant(width, height, {light, light, light}),
                                      .attachments = {{"depth", depth}},
                                      .camera = perspective};
                    const Values values = {{"focus_distance", 1},
                                           {"f_number", 1},
                                           {"max_circle_of_confusion", 0.1},
                                           {"axial_aberration", axial},
                                           {"quality", level_names[level]}};
                    const Worst worst = worst_difference(run_effect("depth_of_field", input, values),
                                                         convert<double>(input.color));
                    INFO(level_names[level] << ", axial " << axial);
                    CHECK(worst.absolute <= light * rounding);
                }
            }
        }
    }
}

TEST_CASE("a point inside the picture keeps its energy and spreads as a disc of the circle's diameter") {
    for (int level : {low, medium, ultra, reference_level}) {
        for (double side : {0.8, -0.8}) {
            for (double diameter : {6.0, 8.0, 10.5}) {
                Spread mean;
                for (int phase : {0, 1}) { // left and right in a block
                    const Input input = scene(impulse(size, size, 48 + phase, 45, 100),
                                              [&](int, int) { return distance_with(side); });
                    const Image result =
                        run_effect("depth_of_field", input, small_lens(level, diameter / 0.8));
                    const Spread found = spread_of(result, 0, 48 + phase, 45);
                    CHECK(found.energy / 100 == Approx(1).margin(0.005));
                    mean.variance += found.variance / 2;
                }
                INFO(level_names[level] << ", diameter " << diameter << ", side " << side);
                // A uniform disc's variance on an axis is d^2/16. Discs of one to three texels of 2 px have few
                // places for an edge; the points of the reference are rounded to whole pixels.
                const double margin = level <= medium ? 1.1 : 0.75;
                CHECK(4 * std::sqrt(mean.variance) == Approx(diameter).margin(margin));
            }
        }
    }
}

TEST_CASE("a wider aperture never blurs less") {
    for (int level : all_levels) {
        for (double side : {0.8, -0.8}) {
            double before = -1;
            for (double f_number : {32, 16, 8, 6, 5, 4, 3, 2, 1}) {
                Values values = small_lens(level, 12);
                values["f_number"] = f_number;
                const Input input =
                    scene(impulse(size, size, 48, 45, 100), [&](int, int) { return distance_with(side); });
                const double variance =
                    spread_of(run_effect("depth_of_field", input, values), 0, 48, 45).variance;
                INFO(level_names[level] << ", f/" << f_number << ", side " << side);
                CHECK(variance >= before - 1e-6);
                before = variance;
            }
            CHECK(before > 4);
        }
    }
}

TEST_CASE("a sharp bright edge does not leak into the blur behind it") {
    for (int level : all_levels) {
        for (int edge : {47, 48}) { // within a block of the reduced layer and between two
            const Image color = painted(size, size, [&](int x, int) { return x < edge ? 1000 : 0.5; });
            const auto distance = [&](int x, int) { return x < edge ? 4.0 : distance_with(0.9); };
            // The truth is the input: a sharp edge hides a constant background. The gate is 0.5 % of 1000.
            const Worst worst = worst_difference(run(level, color, distance), convert<double>(color));
            INFO(level_names[level]);
            if (level == classic)
                CHECK(worst.absolute > 100); // what the gate is against
            else
                CHECK(worst.absolute <= 1000 * 5e-5); // weight of what is in focus, 2^-16, times 3 texels
        }
    }
}

TEST_CASE("a near edge spreads over the sharp background as a disc's edge does") {
    // What the layers' texels soften of a disc of 10 px; a pixel is a tenth of it.
    const std::pair<int, double> bounds[] = {
        {low, 0.09}, {medium, 0.09}, {ultra, 0.04}, {reference_level, 0.03}};
    const Image color = painted(size, size, [](int x, int) { return x < 48 ? 1 : 0; });
    for (const auto& [level, bound] : bounds) {
        const double diameter = 10;
        const Image result = run(
            level, color, [](int x, int) { return x < 48 ? distance_with(-0.9) : 4.0; }, diameter / 0.9);
        double worst = 0;
        for (int x = 30; x < 66; ++x) {
            // Coverage at t radii from the edge: 1/2 + (t sqrt(1 - t^2) + asin t) / pi.
            const double t = std::clamp((48 - (x + 0.5)) / (diameter / 2), -1.0, 1.0);
            const double coverage = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
            worst = std::max(worst, std::abs(result.at(x, 50, 0) - coverage));
        }
        INFO(level_names[level]);
        CHECK(worst <= bound);
        CHECK((result.at(47, 50, 0) + result.at(48, 50, 0)) / 2 == Approx(0.5).margin(0.04));
        CHECK(result.at(20, 50, 0) == Approx(1).margin(1e-4));
        CHECK(result.at(80, 50, 0) == 0);
    }
}

TEST_CASE("axial aberration gives each colour its own circle, and none at 0") {
    // Signed circles grow by H e / (2 N tan(fov/2)) for a focal length shorter by the share e.
    const auto bending = [](double micrometres) { return 1 / (micrometres * micrometres); };
    const double whole = bending(0.464) - bending(0.612);
    for (int level : {medium, ultra, reference_level}) { // low's texels are too coarse for 3 px
        for (double side : {0.8, -0.8}) {
            const auto distance = [&](int, int) { return distance_with(side); };
            const Input input = scene(impulse(size, size, 48, 45, 100), distance);
            Values values = small_lens(level, 8 / 0.8);
            const Image plain = run_effect("depth_of_field", input, values);
            values["axial_aberration"] = 0;
            CHECK(same_bits(run_effect("depth_of_field", input, values), plain));
            CHECK(same_bits(painted(size, size, [&](int x, int y) { return plain.at(x, y, 0); }),
                            three_channels(plain)));

            const double shift = 3; // pixels, red to blue
            values["axial_aberration"] = shift * 2 * perspective.tan_half_fov() / size;
            const Image result = run_effect("depth_of_field", input, values);
            for (const auto& [channel, micrometres] : {std::pair{0, 0.612}, {1, 0.549}, {2, 0.464}}) {
                const double share = (bending(micrometres) - bending(0.549)) / whole;
                const double diameter = std::abs(std::copysign(8, side) + shift * share);
                const Spread found = spread_of(result, channel, 48, 45);
                INFO(level_names[level] << ", side " << side << ", channel " << channel);
                CHECK(found.energy / 100 == Approx(1).margin(0.005));
                CHECK(4 * std::sqrt(found.variance) == Approx(diameter).margin(1.1)); // one place in a block
            }
        }
    }
}

TEST_CASE("a shifted lens has the same circles of confusion, and the part of a larger picture") {
    // The sensor stays parallel to the plane in focus: the circle depends on the distance along the view axis alone.
    constexpr Part part = {.x = size / 2, .y = 0, .width = size, .height = size};
    const Input whole = scene(noise(2 * size, size, 0, 4), layered);
    const Input input = part_of(whole, part);
    Input centred = input;
    centred.camera.principal_point = {0, 0};
    for (int level : all_levels) {
        const Image wide = part_of(run_effect("depth_of_field", whole, small_lens(level)), part);
        const Image result = run_effect("depth_of_field", input, small_lens(level));
        CHECK(same_bits(result, run_effect("depth_of_field", centred, small_lens(level))));
        // Foreground reaches 6 px from its own place, and what it covers is filled from as far again.
        constexpr int border = 16;
        const Part inside = {border, 0, size - 2 * border, size};
        INFO(level_names[level]);
        CHECK(worst_difference(part_of(result, inside), doubled_precision(part_of(wide, inside))).absolute
              <= 4 * rounding);
    }
}
