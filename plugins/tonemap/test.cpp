#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr double ulp = 0x1p-23; // of 1, the brightest output
constexpr float infinity = std::numeric_limits<float>::infinity();
enum Operator { aces, reinhard, hable, plain_clamp };
constexpr Operator all_operators[] = {aces, reinhard, hable, plain_clamp};

Values with(Operator choice, Values more = {}) {
    more["operator"] = choice;
    return more;
}

double luminance(const Image& image, int x, int y) {
    return 0.2126 * image.at(x, y, 0) + 0.7152 * image.at(x, y, 1) + 0.0722 * image.at(x, y, 2);
}

/// 0, then 99999 steps of equal ratio from 1e-6 to 65504.
Image grey_ramp() {
    Image image(400, 250, 3);
    const double last = static_cast<double>(image.pixel_count() - 1);
    for (std::size_t i = 1; i < image.pixel_count(); ++i) {
        const double value = 1e-6 * std::pow(65504e6, static_cast<double>(i - 1) / (last - 1));
        for (int c = 0; c < 3; ++c)
            image.values[3 * i + c] = static_cast<float>(value);
    }
    return image;
}

} // namespace

TEST_CASE("the picture is the float64 reference's") {
    const std::pair<float, float> ranges[] = {{-0.1f, 1}, {-5, 60}, {0, 0.01f}, {0, 65504}};
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 40}, {97, 61}};
    for (Operator choice : all_operators) {
        for (const Values& more :
             {Values{}, Values{{"exposure", -3.3}}, Values{{"exposure", 10}, {"white", 1}},
              Values{{"exposure", -10}, {"white", 1000}}}) {
            for (const auto& [low, high] : ranges) {
                for (const auto& [width, height] : sizes) {
                    const Input input{.color = noise(width, height, low, high)};
                    const Values values = with(choice, more);
                    const Worst worst =
                        worst_difference(run_effect("tonemap", input, values),
                                         reference(reference_input("tonemap", input, values)));
                    INFO("operator " << choice << ", light " << low << " to " << high);
                    // Two divisions of 2.5 ulp, and matrices whose rows' absolute values sum to 2.2.
                    CHECK(worst.absolute <= 16 * ulp);
                }
            }
        }
    }
}

TEST_CASE("grey gets brighter with light, from exactly 0 to 1, and stays grey") {
    const Image ramp = grey_ramp();
    for (Operator choice : all_operators) {
        const Image result = run_effect("tonemap", {.color = ramp}, with(choice));
        CAPTURE(choice);
        CHECK((result.values[0] == 0 && !std::signbit(result.values[0])));
        double largest_fall = 0, largest_tint = 0;
        for (std::size_t i = 1; i < result.pixel_count(); ++i) {
            const float* now = &result.values[4 * i];
            largest_fall = std::max(largest_fall, double(now[-4]) - now[0]);
            largest_tint = std::max(largest_tint, double(std::max({now[0], now[1], now[2]}))
                                                      - std::min({now[0], now[1], now[2]}));
        }
        // Where the curve is flat, neighbours may differ by their rounding: two divisions of 2.5 ulp.
        CHECK(largest_fall <= (choice == plain_clamp ? 0 : 5 * ulp));
        // The rows of the published ACES matrices sum to 1 only within their 5 digits.
        CHECK(largest_tint <= (choice == aces ? 5e-5 : 4 * ulp));
        CHECK(result.values[4 * (result.pixel_count() - 1)] == Approx(1).margin(1e-6));
    }
}

TEST_CASE("landmarks of the curves") {
    const auto grey = [](double light, const Values& values) {
        const float value = static_cast<float>(light);
        return double(
            run_effect("tonemap", {.color = constant(1, 1, {value, value, value})}, values).at(0, 0, 1));
    };
    CHECK(grey(0.18, with(aces)) == Approx(0.213).margin(0.002));
    CHECK(grey(4, with(reinhard)) == Approx(1).margin(1e-6));
    CHECK(grey(1, with(reinhard, {{"white", 1000}})) == Approx(0.5).margin(1e-5));
    CHECK(grey(5.6, with(hable)) == Approx(1).margin(1e-6));
    CHECK(grey(0.25, with(plain_clamp, {{"exposure", 1}})) == 0.5);
}

TEST_CASE("a stop of exposure is twice the light to the last bit") {
    const Image color = noise(41, 23, -5, 60);
    Image twice = color;
    for (float& value : twice.values)
        value *= 2;
    for (Operator choice : all_operators) {
        CHECK(same_bits(run_effect("tonemap", {.color = twice}, with(choice)),
                        run_effect("tonemap", {.color = color}, with(choice, {{"exposure", 1}}))));
    }
}

TEST_CASE("reinhard keeps the luminance of its curve, also of colours that do not fit the display") {
    const Image color = noise(64, 64, 0, 8);
    const Image result = run_effect("tonemap", {.color = color}, with(reinhard));
    double worst = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const double before = luminance(color, x, y);
            const double wanted = std::min(before * (1 + before / 16) / (1 + before), 1.0);
            worst = std::max(worst, std::abs(luminance(result, x, y) - wanted));
        }
    }
    CHECK(worst <= 16 * ulp);
}

TEST_CASE("bright colours turn white with aces") {
    const Image result = run_effect("tonemap", {.color = constant(1, 1, {1000, 20, 10})}, with(aces));
    CHECK(result.at(0, 0, 0) == 1.0f);
    CHECK(result.at(0, 0, 1) > 0.8f);
    CHECK(result.at(0, 0, 2) > 0.6f);
}

TEST_CASE("clamp leaves what a display can show as it is") {
    const Image color = noise(41, 23, 0, 1);
    CHECK(same_bits(run_effect("tonemap", {.color = color}, with(plain_clamp)), color));
}

TEST_CASE("hostile pixels come out within 0..1") {
    const float hostile[] = {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(),
                             65504,    -65504,    3e38f,
                             -3e38f,   1e-40f,    -0.0f};
    Image color(9, 9, 3);
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x) {
            color.at(x, y, 0) = hostile[x];
            color.at(x, y, 1) = hostile[y];
            color.at(x, y, 2) = hostile[(x + y) % 9];
        }
    }
    for (Operator choice : all_operators) {
        for (double exposure : {-10.0, 0.0, 10.0}) {
            const Image result = run_effect("tonemap", {.color = color},
                                            with(choice, {{"exposure", exposure}, {"white", 1000}}));
            bool within = true;
            for (float value : result.values)
                within = within && value >= 0 && value <= 1; // false for NaN
            CAPTURE(choice, exposure);
            CHECK(within);
            CHECK(result.at(2, 2, 0) == 0); // not a number, not a number, negative
        }
        const Image infinite = constant(1, 1, {infinity, infinity, infinity});
        CHECK(run_effect("tonemap", {.color = infinite}, with(choice)).at(0, 0, 0) == Approx(1).margin(1e-6));
    }
}
