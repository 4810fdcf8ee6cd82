#include "exact_glow.hpp"

#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
enum Mode { scatter, threshold, emission };
enum Level { low, medium, high, ultra, best, classic };
std::string_view word_of(Level level) {
    constexpr std::string_view words[] = {"low", "medium", "high", "ultra", "reference", "classic"};
    return words[level];
}
constexpr Level all_levels[] = {low, medium, high, ultra, best, classic};
constexpr Level pyramids[] = {low, medium, high, ultra, best}; // all but the one that loses light

Values with(Level level, Values more = {}) {
    more["quality"] = level;
    return more;
}

Values with(Mode mode, Values more = {}) {
    more["mode"] = mode;
    return more;
}

/// The next lower half float, of those that are not denormal.
float in_half(double value) {
    const double unit = std::exp2(std::floor(std::log2(value)) - 10);
    return static_cast<float>(std::floor(value / unit) * unit);
}

struct Moments {
    double sum = 0, x = 0, y = 0; ///< of channel 0; centroid in pixels
};

Moments moments(const Image& image) {
    Moments found;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double value = image.at(x, y, 0);
            found.sum += value;
            found.x += value * x;
            found.y += value * y;
        }
    }
    found.x /= found.sum;
    found.y /= found.sum;
    return found;
}

/// Weighted sums of at most 40 images, each with some 40 roundings of half an ulp that mostly cancel.
constexpr double rounding = 2e-6;
/// Filtered samples lie at places that are rounded to 2^-24 of the image's size: this share of a texel, of sizes to
/// 256.
constexpr double placing = 256.0 / (1 << 23);

double parity(double brightest) {
    return brightest * (rounding + placing);
}

/// Sum of |glow - truth| for a point of light 1, worst of some places; of each level.
double distance_to_truth(Level level, int size, double deviation) {
    const ExactGlow truth(size, size, deviation);
    double worst = 0;
    for (int shift : {0, 1, 3, 6}) {
        const Image light = impulse(size, size, size / 2 + shift, size / 2 - 2 * shift, 1);
        const Image64 expected = truth.glow_of(convert<double>(light));
        const Image glow = run_effect("bloom", {.color = light},
                                      with(level, {{"intensity", 1}, {"radius", deviation / size}}));
        double sum = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x)
                sum += std::abs(glow.at(x, y, 0) - expected.at(x, y, 0));
        }
        worst = std::max(worst, sum);
    }
    return worst;
}

} // namespace

TEST_CASE("the picture is the float64 reference's, at every level") {
    const std::pair<int, int> sizes[] = {{1, 1}, {53, 1}, {2, 3}, {64, 48}, {77, 51}};
    for (Level level : all_levels) {
        for (Mode mode : {scatter, threshold, emission}) {
            for (const Values& more :
                 {Values{{"radius", 0.5}, {"intensity", 1}}, Values{{"radius", 0.01}, {"tint.1", 0.25}},
                  Values{{"threshold", 5}, {"knee", 0}, {"firefly_guard", 0.5}},
                  Values{{"threshold", 3}, {"knee", 1}}}) {
                for (const auto& [width, height] : sizes) {
                    Input input{.color = noise(width, height, -1, 8)};
                    if (mode == emission) input.attachments["emission"] = noise(width, height, 0, 30, 7);
                    const Values values = with(level, with(mode, more));
                    const Worst worst = worst_difference(run_effect("bloom", input, values),
                                                         reference(reference_input("bloom", input, values)));
                    INFO("level " << level << ", mode " << mode << ", " << width << "x" << height << " at "
                                  << worst.x << "," << worst.y);
                    CHECK(worst.absolute <= parity(mode == emission ? 30 : 8));
                }
            }
        }
    }
}

TEST_CASE("the finer the level, the nearer to the exact convolution") {
    // Sums of |error| over a point of light, in % of its light: the largest seen, rounded up.
    const std::pair<double, std::vector<double>> cases[] = {{4, {0.44, 0.165, 0.066, 0.034, 0.0095}},
                                                            {12, {0.30, 0.12, 0.05, 0.024, 0.0085}}};
    for (const auto& [deviation, bounds] : cases) {
        double before = 1;
        for (Level level : pyramids) {
            const double distance = distance_to_truth(level, 128, deviation);
            INFO("level " << level << ", standard deviation " << deviation << " pixels");
            CHECK(distance <= bounds[level]);
            CHECK(distance < before);
            before = distance;
        }
    }
}

TEST_CASE("hostile pixels are repaired as the reference repairs them, and stay where they are") {
    Image color = noise(90, 70, 0, 4);
    const float hostile[] = {not_a_number, infinity, -infinity, -3, -0.0f, 1e-42f, 65504};
    for (int i = 0; i < 7; ++i)
        color.at(10 * i + 9, 33 + 2 * i, i % 3) = hostile[i];
    for (Level level : all_levels) {
        for (const Values& more :
             {with(scatter), with(threshold), with(scatter, {{"firefly_guard", 0.25}})}) {
            const Input input{.color = color};
            Values values = with(level, more);
            values["intensity"] = 1.0 / 3;
            const Image result = run_effect("bloom", input, values);
            const Image64 expected = reference(reference_input("bloom", input, values));
            double worst = 0;
            for (int y = 0; y < color.height; ++y) {
                for (int x = 0; x < color.width; ++x) {
                    for (int c = 0; c < 3; ++c) {
                        if (!std::isfinite(color.at(x, y, c))) continue;
                        const double error = std::abs(result.at(x, y, c) - expected.at(x, y, c));
                        worst = std::max(worst, std::isfinite(error) ? error : 1e30);
                    }
                }
            }
            INFO("level " << level);
            CHECK(worst <= parity(65504));
        }
    }
}

TEST_CASE("where every pixel is infinite or no number the glow is finite") {
    for (float value : {infinity, not_a_number}) {
        for (Level level : pyramids) {
            for (double guard : {0.0, 1.0}) {
                Image color = constant(24, 24, {value, value, value});
                for (int y = 0; y < 24; ++y)
                    color.at(20, y, 0) = color.at(20, y, 1) = color.at(20, y, 2) = 1;
                const Image result =
                    run_effect("bloom", {.color = color}, with(level, {{"firefly_guard", guard}}));
                for (int y = 0; y < 24; ++y)
                    CHECK(std::isfinite(result.at(20, y, 1)));
            }
        }
    }
}

TEST_CASE("finite light gives finite light in half floats, the brightest included") {
    for (Level level : all_levels) {
        for (Mode mode : {scatter, threshold, emission}) {
            Input input{.color = constant(40, 30, {65504, 65504, 0})};
            if (mode == emission) input.attachments["emission"] = input.color;
            const Image result =
                run_effect("bloom", input, with(level, with(mode, {{"intensity", 1}})), Format::rgba16f);
            CHECK(std::all_of(result.values.begin(), result.values.end(),
                              [](float x) { return std::isfinite(x); }));
        }
    }
}

TEST_CASE("constant light keeps its luminance at every size and level") {
    const std::pair<int, int> sizes[] = {{64, 32}, {37, 21}, {1, 33}};
    for (Level level : pyramids) {
        for (double guard : {0.0, 1.0}) {
            for (const auto& [width, height] : sizes) {
                const int step =
                    guard == 0 && width == 64 ? 1 : 19; // all luminances at one size, both ends at all
                for (int i = 0; i < 20; i += step) {
                    const float luminance = in_half(std::exp2(-14 + 30.0 * i / 19) * (i == 19 ? 0.9998 : 1));
                    const Input input{.color = constant(width, height, {luminance, luminance, luminance})};
                    const Values values =
                        with(level, {{"intensity", 1}, {"radius", 0.1}, {"firefly_guard", guard}});
                    const Worst in_32 =
                        worst_difference(run_effect("bloom", input, values), convert<double>(input.color));
                    const Worst in_16 = worst_difference(run_effect("bloom", input, values, Format::rgba16f),
                                                         convert<double>(input.color));
                    INFO("level " << level << ", " << width << "x" << height << " of " << luminance);
                    CHECK(in_32.absolute
                          <= (level == best ? 3e-6 : 1e-6) * luminance); // 80 passes of roundings, or 30
                    CHECK(in_16.absolute <= 1e-3 * luminance);           // one truncation to half: 9.8e-4
                }
            }
        }
    }
}

TEST_CASE("a point of light keeps its energy and its place, wherever it is") {
    for (Level level : pyramids) {
        // Of filtered samples, by the rounding of their places; `low` says why half a pixel.
        const double shift_bound = level == low ? 0.5 : 0.01;
        for (const auto& [width, height] : {std::pair{256, 256}, std::pair{255, 241}}) {
            for (int shift = 0; shift < 9; shift += 2) {
                const int x = width / 2 + shift;
                const int y = height / 2 - 2 * shift;
                const Input input{.color = impulse(width, height, x, y, 1000)};
                const Moments found =
                    moments(run_effect("bloom", input, with(level, {{"intensity", 1}, {"radius", 0.016}})));
                INFO("level " << level << ", " << width << "x" << height << " shift " << shift);
                CHECK(std::abs(found.sum / 1000 - 1)
                      <= 2e-5); // roundings and places of 65536 values that are added
                CHECK(std::abs(found.x - x) <= shift_bound);
                CHECK(std::abs(found.y - y) <= shift_bound);
            }
        }
    }
}

TEST_CASE("the glow that is added holds all the light it is of, also what stays in its pixel") {
    const int size = 192, x = 99, y = 90;
    for (Level level : pyramids) {
        for (Mode mode : {threshold, emission}) {
            for (double guard : {0.0, 1e-6}) {
                Input input{.color = constant(size, size, {0, 0, 0})};
                (mode == emission ? input.attachments["emission"] : input.color) =
                    impulse(size, size, x, y, 1000);
                // A threshold of 0 passes all: `low` sees means of pixels, of which a larger one takes more. The
                // guard has nothing to hold back but makes the light by a pass; a firefly would lose all.
                Values values{
                    {"intensity", 0.5}, {"radius", 0.02}, {"threshold", 0}, {"firefly_guard", guard}};
                if (guard > 0) {
                    for (int i = 0; i < 9; ++i)
                        (mode == emission ? input.attachments["emission"] : input.color)
                            .at(x + i % 3 - 1, y + i / 3 - 1, 0) = 1000;
                }
                const double light = guard > 0 ? 9000 : 1000;
                const double before = mode == emission ? 0 : light;
                const Image result = run_effect("bloom", input, with(level, with(mode, values)));
                INFO("level " << level << ", mode " << mode << ", guard " << guard);
                // Roundings and places of 36864 values that are added.
                CHECK(std::abs((moments(result).sum - before) / (0.5 * light) - 1) <= 2e-5);
            }
        }
    }
}

TEST_CASE("no light is lost or made at the border") {
    const auto energy = [](Level level, int width, int height, int x, int y) {
        const Input input{.color = impulse(width, height, x, y, 1000)};
        return moments(run_effect("bloom", input, with(level, {{"intensity", 1}, {"radius", 0.1}}))).sum
               / 1000;
    };
    for (Level level : pyramids) {
        INFO("level " << level);
        for (const auto& [x, y] : {std::pair{0, 0}, std::pair{127, 63}, std::pair{60, 0}})
            CHECK(std::abs(energy(level, 128, 64, x, y) - 1) <= 2e-5); // as above
        // At odd sizes the border lies within a coarse texel; mirror images are interpolated there.
        const double bound = level == low ? 0.25 : level == best ? 2e-5 : 0.04;
        for (const auto& [x, y] : {std::pair{98, 30}, std::pair{98, 60}, std::pair{50, 60}})
            CHECK(std::abs(energy(level, 99, 61, x, y) - 1) <= bound);
    }
}

TEST_CASE("the radius is the glow's standard deviation, at any resolution") {
    for (Level level : pyramids) {
        for (int size : {128, 256}) {
            for (double radius : {0.01, 0.03}) {
                const Input input{.color = impulse(size, size, size / 2, size / 2, 1000)};
                const Image glow =
                    run_effect("bloom", input, with(level, {{"intensity", 1}, {"radius", radius}}));
                double variance = 0;
                for (int y = 0; y < size; ++y) {
                    for (int x = 0; x < size; ++x)
                        variance += glow.at(x, y, 0) / 1000 * std::pow(x - size / 2, 2);
                }
                INFO("level " << level << ", " << size << " pixels high, radius " << radius);
                // In `low` the mean over all positions is.
                CHECK(std::sqrt(variance) == Approx(radius * size).epsilon(level == low ? 0.16 : 1e-6));
            }
        }
    }
}

TEST_CASE("the picture changes continuously with the radius") {
    const Input input{.color = noise(64, 64, 0, 4)};
    for (Level level : {low, medium, high}) {
        std::size_t passes = 0;
        int steps_with_new_level = 0;
        Image before;
        for (double radius = 0.015; radius < 0.1; radius *= 1.02) {
            const Values values = with(level, {{"radius", radius}, {"intensity", 1}});
            const Image now = three_channels(run_effect("bloom", input, values));
            const std::size_t now_passes = plan_effect("bloom", input, values).passes.size();
            // 2 % of the radius moves less than 4 % of the light from one blur to the next; light differs by at most
            // 4.
            if (!before.empty()) CHECK(worst_difference(now, convert<double>(before)).absolute <= 4 * 0.04);
            if (passes != 0 && now_passes != passes) ++steps_with_new_level;
            passes = now_passes;
            before = now;
        }
        CHECK(steps_with_new_level >= 2);
    }
}

TEST_CASE("twice the resolution, the same look") {
    // Light of 2x2 pixels, seen at half the size again. In shares of its light, at a standard deviation of 4 pixels:
    // the finest blur is so many pixels wide, whatever their size, and so is a pixel, so the halo's middle differs.
    const double bounds[] = {0.4, 0.15, 0.075, 0.075, 0.065};
    Image twice(128, 128, 3);
    for (int i = 0; i < 4; ++i)
        twice.at(60 + i % 2, 58 + i / 2, 0) = 1;
    for (Level level : pyramids) {
        const Values values = with(level, {{"intensity", 1}, {"radius", 4.0 / 64}});
        const Image once = run_effect("bloom", {.color = impulse(64, 64, 30, 29, 1)}, values);
        const Image larger = run_effect("bloom", {.color = twice}, values);
        double difference = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                double mean = 0;
                for (int i = 0; i < 4; ++i)
                    mean += larger.at(2 * x + i % 2, 2 * y + i / 2, 0) / 4;
                difference += std::abs(mean - once.at(x, y, 0));
            }
        }
        INFO("level " << level);
        CHECK(difference <= bounds[level]);
    }
}

TEST_CASE("scattering is linear: twice the light, twice the picture, bit for bit") {
    const Image light = noise(61, 47, 0, 8);
    for (Level level : all_levels) {
        for (double guard : {0.0, 0.75}) {
            const Values values = with(level, {{"intensity", 0.3}, {"firefly_guard", guard}});
            const Image once = run_effect("bloom", {.color = light}, values);
            for (float factor : {0.0009765625f, 4096.0f}) {
                const Image result = run_effect("bloom", {.color = scaled(light, factor)}, values);
                INFO("level " << level << ", guard " << guard);
                CHECK(same_bits(three_channels(result), scaled(three_channels(once), factor)));
            }
        }
    }
}

TEST_CASE("scattering is additive") {
    const Image one = noise(61, 47, 0, 8, 1);
    const Image other = noise(61, 47, 0, 8, 2);
    Image both = one;
    for (std::size_t i = 0; i < both.values.size(); ++i)
        both.values[i] += other.values[i];
    for (Level level : all_levels) {
        Image64 sum = convert<double>(three_channels(run_effect("bloom", {.color = one}, with(level))));
        const Image second = three_channels(run_effect("bloom", {.color = other}, with(level)));
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += second.values[i];
        CHECK(worst_difference(run_effect("bloom", {.color = both}, with(level)), sum).absolute
              <= 16 * rounding);
    }
}

TEST_CASE("a mirrored picture gives a mirrored picture when every level halves evenly") {
    const Image light = noise(128, 64, 0, 8);
    for (Level level : all_levels) {
        const Image there = run_effect("bloom", {.color = light}, with(level));
        const Image back = run_effect("bloom", {.color = mirrored(light)}, with(level));
        CHECK(
            worst_difference(mirrored(three_channels(back)), convert<double>(three_channels(there))).absolute
            <= parity(8));
    }
}

TEST_CASE("light that moves takes its glow along") {
    // In shares of a point's light: the grids of smaller images show a little; `best` has none.
    const double bounds[] = {0.2, 0.06, 0.015, 0.012, 1e-5};
    for (Level level : pyramids) {
        const Values values = with(level, {{"intensity", 1}, {"radius", 0.06}});
        const Image here = run_effect("bloom", {.color = impulse(128, 128, 64, 64, 1)}, values);
        double worst = 0;
        for (int shift = 1; shift < 8; ++shift) {
            const Image there = run_effect("bloom", {.color = impulse(128, 128, 64 + shift, 64, 1)}, values);
            double difference = 0;
            for (int y = 0; y < 128; ++y) {
                for (int x = 16; x < 112; ++x)
                    difference += std::abs(there.at(x + shift, y, 0) - here.at(x, y, 0));
            }
            worst = std::max(worst, difference);
        }
        INFO("level " << level);
        CHECK(worst <= bounds[level]);
    }
}

TEST_CASE("the guard takes a firefly's glow, and little of any light that is wider") {
    const auto glow_of = [](const Image& light, double guard) {
        return moments(run_effect("bloom", {.color = light},
                                  with(high, {{"intensity", 1}, {"radius", 0.02}, {"firefly_guard", guard}})))
            .sum;
    };
    Image firefly = constant(96, 96, {1, 1, 1});
    firefly.at(40, 50, 0) = 5000;
    // The picture's own pixel keeps what does not leave it; of the 5000 no more than 2 are spread.
    CHECK(glow_of(firefly, 0) == Approx(96 * 96 + 4999).epsilon(1e-4));
    CHECK(glow_of(firefly, 0.5) < 96 * 96 + 0.4 * 4999);
    Image lamp = constant(96, 96, {0, 0, 0});
    for (int i = 0; i < 64; ++i)
        lamp.at(40 + i % 8, 50 + i / 8, 0) = 100;
    CHECK(glow_of(lamp, 0.5)
          == Approx(6400).epsilon(0.07)); // the corners' neighbours are 3/8 lit, with 0.5: 3/4
}

TEST_CASE("black stays black, and below the threshold nothing changes at all") {
    for (Level level : all_levels) {
        for (double guard : {0.0, 1.0}) {
            const Image dark = run_effect("bloom", {.color = constant(33, 20, {0, 0, 0})},
                                          with(level, {{"intensity", 1}, {"firefly_guard", guard}}));
            CHECK(same_bits(three_channels(dark), constant(33, 20, {0, 0, 0})));
        }
        const Image dim = noise(33, 20, 0, 0.49f);
        const Image result =
            run_effect("bloom", {.color = dim}, with(level, with(threshold, {{"intensity", 1}})));
        CHECK(same_bits(three_channels(result), dim));
    }
}

TEST_CASE("emission alone glows; the picture's own light does not") {
    Input input{.color = constant(64, 64, {9, 9, 9})};
    input.attachments["emission"] = impulse(64, 64, 30, 31, 500);
    for (Level level : pyramids) {
        const Values values = with(level, with(emission, {{"intensity", 0.5}, {"radius", 0.02}}));
        const Image result = run_effect("bloom", input, values);
        const Image64 expected = reference(reference_input("bloom", input, values));
        double sum = 0, expected_sum = 0;
        for (double value : expected.values)
            expected_sum += value - 9;
        for (float value : three_channels(result).values)
            sum += value - 9;
        CHECK(sum == Approx(expected_sum).epsilon(1e-3)); // rounding of values near 9 to float, 4096 of them
        CHECK(sum / 3 == Approx(250).epsilon(1e-3));      // as above
    }
}

TEST_CASE("without cause the effect does not run, and the picture keeps its bits") {
    Image color = noise(20, 10, -2, 2);
    color.at(3, 3, 0) = -0.0f;
    const std::uint32_t payload = 0x7fc01234u;
    std::memcpy(&color.at(4, 4, 1), &payload, sizeof payload);
    const Input input{.color = color};
    const std::pair<Values, Moment> cases[] = {{{{"intensity", 0}}, Moment::configuration},
                                               {{{"radius", 0}}, Moment::configuration},
                                               {{{"radius", 1e-200}}, Moment::configuration},
                                               {with(emission), Moment::scene}};
    for (const auto& [values, moment] : cases) {
        const Plan plan = plan_effect("bloom", input, values);
        CHECK(plan.passes.empty());
        REQUIRE(plan.effects.size() == 1);
        CHECK(plan.effects[0].status == EffectStatus::skipped);
        CHECK(plan.effects[0].moment == moment);
        CHECK(same_bits(run_effect("bloom", input, values), color));
    }
}
