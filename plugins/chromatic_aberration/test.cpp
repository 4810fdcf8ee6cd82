#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr double ulp = 0x1p-23; // of 1
constexpr float infinity = std::numeric_limits<float>::infinity();
// Where the ends of the spectrum lie relative to green, as shares of their distance, by Cauchy's 1 /
// wavelength^2.
const double red_end =
    (std::pow(0.612, -2) - std::pow(0.549, -2)) / (std::pow(0.464, -2) - std::pow(0.612, -2));
const double blue_end = red_end + 1;
const double pi = std::acos(-1.0);

Image run(const Image& color, double strength) {
    return run_effect("chromatic_aberration", {.color = color}, {{"strength", strength}});
}

/// The share of the radius by which a sample at `end` of the spectrum is displaced.
double share(const Image& image, double strength, double end) {
    return strength * end * image.height / (0.5 * std::hypot(image.width, image.height));
}

/// f of the offset from the centre in pixels, the same in all channels.
Image painted(int width, int height, const std::function<double(double, double)>& f) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c)
                image.at(x, y, c) = static_cast<float>(f(x + 0.5 - width / 2.0, y + 0.5 - height / 2.0));
        }
    }
    return image;
}

} // namespace

TEST_CASE("the picture is the float64 reference's") {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 17}, {31, 1}, {97, 61}, {64, 200}};
    for (const auto& [width, height] : sizes) {
        for (double strength : {0.003, -0.02, 0.05}) {
            const Values values = {{"strength", strength}};
            const Input input{.color = noise(width, height, -5, 60)};
            const Worst worst =
                worst_difference(run_effect("chromatic_aberration", input, values),
                                 reference(reference_input("chromatic_aberration", input, values)));
            INFO(width << "x" << height << ", strength " << strength);
            // A sampler may round its two weights to 8 fractional bits, half a step each way.
            CHECK(worst.absolute <= 65 * 2 * (1 / 512.0));
        }
    }
}

TEST_CASE("strength 0 changes no bit") {
    Image color = noise(33, 17, -5, 60);
    color.at(0, 0, 0) = -0.0f;
    color.at(1, 0, 1) = infinity;
    const std::uint32_t payload = 0x7fc12345u;
    std::memcpy(&color.at(2, 0, 2), &payload, sizeof(payload));
    CHECK(same_bits(run(color, 0), color));
    CHECK(plan_effect("chromatic_aberration", {.color = color}, {{"strength", 0}}).effects.at(0).moment
          == "configuration");
}

TEST_CASE("a constant stays as it is to the last bit") {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 50}, {50, 1}, {97, 61}}) {
        for (double strength : {0.001, 0.003, 0.05, -0.05}) {
            const Image color = constant(width, height, {0.1f, -7.3f, 65504});
            CHECK(same_bits(run(color, strength), color));
        }
    }
}

TEST_CASE("a ramp is displaced by each channel's mean, at any resolution") {
    for (int height : {60, 120, 480}) {
        for (double strength : {0.003, 0.04, -0.04}) {
            const int width = 2 * height;
            // 1 over the picture's height, so that the expected change is the displacement in heights.
            const Image color = painted(width, height, [&](double x, double) { return x / height; });
            const Image result = run(color, strength);
            // A kernel that rises towards its end has its mean at 2/3; green has half of its own on either
            // side, at 1/3.
            const double means[] = {2 / 3.0 * red_end, (red_end + blue_end) / 6, 2 / 3.0 * blue_end};
            const int x = width * 4 / 5; // no sample reaches the border, |share| < 0.05
            const double offset = (x + 0.5) / height - 1;
            for (int c = 0; c < 3; ++c) {
                const double expected = offset * (1 + share(color, strength, means[c]));
                CAPTURE(height, strength, c);
                // Half a step of a weight of 8 bits, in pixels; a pixel is 1 / height.
                CHECK(std::abs(result.at(x, height / 3, c) - expected) <= 1 / 512.0 / height + 8 * ulp);
            }
        }
    }
}

TEST_CASE("red moves outwards, blue inwards, radially") {
    const Image color = impulse(121, 81, 100, 40, 1); // right of the centre (60, 40)
    const Image result = run(color, 0.05);
    double center[3] = {}, mass[3] = {}, beside = 0;
    for (int y = 0; y < 81; ++y) {
        for (int x = 0; x < 121; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double value = result.at(x, y, c);
                mass[c] += value;
                center[c] += value * x;
                beside = std::max(beside, std::abs(y - 40) > 1 ? std::abs(value) : 0.0);
            }
        }
    }
    CHECK(center[0] / mass[0] > 100);
    CHECK(center[2] / mass[2] < 100);
    CHECK(beside == 0);
}

TEST_CASE("taps approach the whole spectrum") {
    // The phenomenon itself: 1024 wavelengths per kernel on a wave that is known everywhere.
    const double period = 32, wave = 2 * pi / period;
    const auto light = [&](double x, double y) { return std::sin(wave * x) * std::cos(wave * y); };
    const Image color = painted(320, 200, light);
    for (double strength : {0.003, 0.02, 0.05}) {
        const Image result = run(color, strength);
        double worst = 0;
        for (int y = 20; y < 180; ++y) {
            for (int x = 20; x < 300; ++x) {
                const double dx = x + 0.5 - 160, dy = y + 0.5 - 100;
                double truth[3] = {};
                constexpr int wavelengths = 1024;
                for (int i = 0; i < wavelengths; ++i) {
                    const double t = (i + 0.5) / wavelengths;
                    const double at_red = 1 + t * share(color, strength, red_end);
                    const double at_blue = 1 + t * share(color, strength, blue_end);
                    const double red = light(dx * at_red, dy * at_red) / wavelengths;
                    const double blue = light(dx * at_blue, dy * at_blue) / wavelengths;
                    truth[0] += 2 * t * red;
                    truth[1] += (1 - t) * (red + blue);
                    truth[2] += 2 * t * blue;
                }
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(result.at(x, y, c) - truth[c]));
            }
        }
        CAPTURE(strength);
        // Linear interpolation over a step errs by step^2 / 8 times the second derivative, here at most
        // wave^2 along an axis and 2 wave^2 along a diagonal: taps 1.5 pixels apart on any diagonal, and
        // pixels along two axes.
        CHECK(worst <= wave * wave / 8 * (2 * 1.5 * 1.5 + 2));
    }
}

TEST_CASE("twice the light gives twice the picture to the last bit") {
    const Image color = noise(41, 23, -5, 60);
    const Image once = run(color, 0.03);
    for (float factor : {0x1p10f, 0x1p-10f}) {
        Image scaled = color, expected = once;
        for (float& value : scaled.values)
            value *= factor;
        for (float& value : expected.values)
            value *= factor;
        CHECK(same_bits(run(scaled, 0.03), expected));
    }
}

TEST_CASE("what is not finite stays within the displacement, as finite light") {
    const Image clean = noise(121, 81, 0, 1);
    const double strength = 0.05;
    for (float hostile : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
        Image color = clean;
        for (int c = 0; c < 3; ++c)
            color.at(100, 60, c) = hostile;
        const Image expected = run(clean, strength), result = run(color, strength);
        // 4 pixels in the corner at most, and one for the filter.
        const double reach = std::abs(share(color, strength, blue_end)) * std::hypot(60, 40) + 1.5;
        int non_finite = 0, far_changes = 0;
        for (int y = 0; y < 81; ++y) {
            for (int x = 0; x < 121; ++x) {
                for (int c = 0; c < 3; ++c) {
                    non_finite += !std::isfinite(result.at(x, y, c));
                    far_changes +=
                        std::hypot(x - 100, y - 60) > reach && result.at(x, y, c) != expected.at(x, y, c);
                }
            }
        }
        CHECK(non_finite == 0);
        CHECK(far_changes == 0);
    }
}

TEST_CASE("finite light of any size stays finite") {
    // Blocks of 4 pixels, so that blue's 6 pixels of displacement bring one sign to the other.
    const Image color = painted(320, 200, [](double x, double y) {
        const int block = static_cast<int>(std::floor(x / 4) + std::floor(y / 4));
        return block % 2 == 0 ? 3.4e38 : -3.4e38;
    });
    int non_finite = 0;
    for (float value : run(color, 0.05).values)
        non_finite += !std::isfinite(value);
    CHECK(non_finite == 0);
}

TEST_CASE("the default costs few samples") {
    const auto samples = [](int width, int height, double strength) {
        const Plan plan =
            plan_effect("chromatic_aberration", {.color = Image(width, height, 3)}, {{"strength", strength}});
        const std::string& text = plan.passes.at(0).program->text;
        const auto constant_after = [&](const std::string& name) {
            const std::size_t at = text.find("const int CHROMATIC_ABERRATION_" + name + "_TAPS = ");
            REQUIRE(at != std::string::npos);
            return std::stoi(text.substr(text.find('=', at) + 1));
        };
        return constant_after("RED") + constant_after("BLUE");
    };
    CHECK(samples(1280, 720, 0.003) == 2);
    CHECK(samples(1920, 1080, 0.003) == 3);
    CHECK(samples(3840, 2160, 0.05) == 24); // the most
}
