#include <testing.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
enum Mode { scatter, threshold, emission };

Values with(Mode mode, Values more = {}) {
    more["mode"] = mode;
    return more;
}

Image scaled(Image image, float factor) {
    for (float& value : image.values)
        value *= factor;
    return image;
}

Image three_channels(const Image& image) {
    Image result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            std::memcpy(result.pixel(x, y), image.pixel(x, y), 3 * sizeof(float));
    }
    return result;
}

Image mirrored(const Image& image) {
    Image result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            std::memcpy(result.pixel(image.width - 1 - x, y), image.pixel(x, y), 3 * sizeof(float));
    }
    return result;
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

/// Weighted sums of at most 16 levels, each with some 40 roundings of half an ulp that mostly cancel.
constexpr double rounding = 2e-6;

} // namespace

TEST_CASE("the picture is the float64 reference's") {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 40}, {53, 1}, {2, 3}, {96, 64}, {97, 61}, {200, 7}};
    for (Mode mode : {scatter, threshold, emission}) {
        for (const Values& more :
             {Values{}, Values{{"radius", 0.5}, {"intensity", 1}}, Values{{"radius", 0.004}},
              Values{{"threshold", 0}, {"tint.1", 0.25}}, Values{{"threshold", 5}, {"knee", 0}},
              Values{{"threshold", 3}, {"knee", 1}}}) {
            for (const auto& [width, height] : sizes) {
                Input input{.color = noise(width, height, -1, 8)};
                if (mode == emission) input.attachments["emission"] = noise(width, height, 0, 30, 7);
                const Values values = with(mode, more);
                const Worst worst = worst_difference(run_effect("bloom", input, values),
                                                     reference(reference_input("bloom", input, values)));
                INFO("mode " << mode << ", " << width << "x" << height << " at " << worst.x << ","
                             << worst.y);
                CHECK(worst.absolute <= 30 * rounding); // 30: the largest value
            }
        }
    }
}

TEST_CASE("hostile pixels are repaired as the reference repairs them, and stay where they are") {
    Image color = noise(90, 70, 0, 4);
    const float hostile[] = {not_a_number, infinity, -infinity, -3, -0.0f, 1e-42f, 65504};
    for (int i = 0; i < 7; ++i)
        color.at(10 * i + 9, 33 + 2 * i, i % 3) = hostile[i];
    for (Mode mode : {scatter, threshold}) {
        const Input input{.color = color};
        const Values values = with(mode, {{"intensity", 1.0 / 3}});
        const Image result = run_effect("bloom", input, values);
        const Image64 expected = reference(reference_input("bloom", input, values));
        for (int y = 0; y < color.height; ++y) {
            for (int x = 0; x < color.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    if (!std::isfinite(color.at(x, y, c))) continue;
                    const double error = std::abs(result.at(x, y, c) - expected.at(x, y, c));
                    INFO(x << "," << y << " channel " << c);
                    CHECK(error <= 65504 * rounding);
                }
            }
        }
    }
}

TEST_CASE("finite light gives finite light in half floats, the brightest included") {
    for (Mode mode : {scatter, threshold, emission}) {
        Input input{.color = constant(40, 30, {65504, 65504, 0})};
        if (mode == emission) input.attachments["emission"] = input.color;
        for (float value : run_effect("bloom", input, with(mode, {{"intensity", 1}}), Format::rgba16f).values)
            CHECK(std::isfinite(value));
    }
}

TEST_CASE("constant light keeps its luminance at every size") {
    const std::pair<int, int> sizes[] = {{64, 64}, {97, 61}, {1, 33}, {127, 2}};
    for (const auto& [width, height] : sizes) {
        for (int i = 0; i < 20; ++i) {
            const float luminance =
                static_cast<float>(std::exp2(-14 + 30.0 * i / 19)) * (i == 19 ? 0.9995f : 1);
            const Input input{.color = constant(width, height, {luminance, luminance, luminance})};
            const Worst in_32 =
                worst_difference(run_effect("bloom", input, {{"intensity", 1}, {"radius", 0.5}}),
                                 convert<double>(input.color));
            const Worst in_16 = worst_difference(
                run_effect("bloom", input, {{"intensity", 1}, {"radius", 0.5}}, Format::rgba16f),
                convert<double>(input.color));
            INFO(width << "x" << height << " of " << luminance);
            CHECK(in_32.absolute <= 1e-6 * luminance); // a few roundings of 6e-8
            CHECK(in_16.absolute <= 1e-3 * luminance); // the input's own rounding to half: 4.9e-4
        }
    }
}

TEST_CASE("a point of light keeps its energy and its place, wherever it is") {
    for (const auto& [width, height] : {std::pair{256, 256}, std::pair{255, 241}}) {
        for (int shift = 0; shift < 9; ++shift) {
            const int x = width / 2 + shift;
            const int y = height / 2 - 2 * shift;
            const Input input{.color = impulse(width, height, x, y, 1000)};
            const Moments found = moments(run_effect("bloom", input, {{"intensity", 1}, {"radius", 0.016}}));
            INFO(width << "x" << height << " shift " << shift);
            CHECK(std::abs(found.sum / 1000 - 1)
                  <= 1e-5); // 65536 roundings of the small values that are added
            CHECK(std::abs(found.x - x) <= 0.001);
            CHECK(std::abs(found.y - y) <= 0.001);
        }
    }
}

TEST_CASE("the radius is the glow's standard deviation, at any resolution") {
    for (int size : {128, 256, 512}) {
        for (double radius : {0.01, 0.024, 0.03}) {
            const Input input{.color = impulse(size, size, size / 2, size / 2, 1000)};
            const Image glow = run_effect("bloom", input, {{"intensity", 1}, {"radius", radius}});
            double variance = 0;
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x)
                    variance += glow.at(x, y, 0) / 1000 * std::pow(x - size / 2, 2);
            }
            INFO(size << " pixels high, radius " << radius);
            // The variance of what one position of the impulse gives, not of the mean over all positions.
            CHECK(std::sqrt(variance) == Approx(radius * size).epsilon(0.01));
        }
    }
}

TEST_CASE("the picture changes continuously with the radius") {
    const Input input{.color = noise(64, 64, 0, 4)};
    std::size_t passes = 0;
    int steps_with_new_level = 0;
    Image before;
    for (double radius = 0.015; radius < 0.2; radius *= 1.002) {
        const Values values = {{"radius", radius}, {"intensity", 1}};
        const Image now = three_channels(run_effect("bloom", input, values));
        const std::size_t now_passes = plan_effect("bloom", input, values).passes.size();
        // 0.2 % of the radius is less than 0.6 % of an octave, and light differs by at most 4.
        if (!before.empty()) CHECK(worst_difference(now, convert<double>(before)).absolute <= 4 * 6e-3);
        if (passes != 0 && now_passes != passes) ++steps_with_new_level;
        passes = now_passes;
        before = now;
    }
    CHECK(steps_with_new_level >= 3);
}

TEST_CASE("scattering is linear: twice the light, twice the picture, bit for bit") {
    const Image light = noise(61, 47, 0, 8);
    const Image once = run_effect("bloom", {.color = light}, {{"intensity", 0.3}});
    for (float factor : {0.0009765625f, 2.0f, 4096.0f}) {
        const Image result = run_effect("bloom", {.color = scaled(light, factor)}, {{"intensity", 0.3}});
        CHECK(same_bits(three_channels(result), scaled(three_channels(once), factor)));
    }
}

TEST_CASE("scattering is additive") {
    const Image one = noise(61, 47, 0, 8, 1);
    const Image other = noise(61, 47, 0, 8, 2);
    Image both = one;
    for (std::size_t i = 0; i < both.values.size(); ++i)
        both.values[i] += other.values[i];
    Image64 sum = convert<double>(three_channels(run_effect("bloom", {.color = one})));
    const Image second = three_channels(run_effect("bloom", {.color = other}));
    for (std::size_t i = 0; i < sum.values.size(); ++i)
        sum.values[i] += second.values[i];
    CHECK(worst_difference(run_effect("bloom", {.color = both}), sum).absolute <= 16 * rounding);
}

TEST_CASE("a mirrored picture gives a mirrored picture when every level halves evenly") {
    const Image light = noise(96, 64, 0, 8);
    const Image there = run_effect("bloom", {.color = light});
    const Image back = run_effect("bloom", {.color = mirrored(light)});
    CHECK(worst_difference(mirrored(three_channels(back)), convert<double>(three_channels(there))).absolute
          <= 8 * rounding);
}

TEST_CASE("black stays black, and below the threshold nothing changes at all") {
    const Image dark = run_effect("bloom", {.color = constant(33, 20, {0, 0, 0})}, {{"intensity", 1}});
    CHECK(same_bits(three_channels(dark), constant(33, 20, {0, 0, 0})));
    const Image dim = noise(33, 20, 0, 0.49f);
    const Image result = run_effect("bloom", {.color = dim}, with(threshold, {{"intensity", 1}}));
    CHECK(same_bits(three_channels(result), dim));
}

TEST_CASE("emission alone glows; the picture's own light does not") {
    Input input{.color = constant(64, 64, {9, 9, 9})};
    input.attachments["emission"] = impulse(64, 64, 30, 31, 500);
    const Image result = run_effect("bloom", input, with(emission, {{"intensity", 0.5}, {"radius", 0.02}}));
    Image64 added = convert<double>(three_channels(result));
    double sum = 0;
    for (double& value : added.values)
        sum += value - 9;
    CHECK(sum / 3 == Approx(250).epsilon(1e-3)); // rounding of values near 9 to float, 4096 of them
}

TEST_CASE("without cause the effect does not run, and the picture keeps its bits") {
    Image color = noise(20, 10, -2, 2);
    color.at(3, 3, 0) = -0.0f;
    const std::uint32_t payload = 0x7fc01234u;
    std::memcpy(&color.at(4, 4, 1), &payload, sizeof payload);
    const Input input{.color = color};
    const std::pair<Values, std::string> cases[] = {
        {{{"intensity", 0}}, "configuration"}, {{{"radius", 0}}, "configuration"}, {with(emission), "scene"}};
    for (const auto& [values, moment] : cases) {
        const Plan plan = plan_effect("bloom", input, values);
        CHECK(plan.passes.empty());
        REQUIRE(plan.effects.size() == 1);
        CHECK(plan.effects[0].status == EffectStatus::skipped);
        CHECK(plan.effects[0].moment == moment);
        CHECK(same_bits(run_effect("bloom", input, values), color));
    }
}
