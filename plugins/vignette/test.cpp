#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr double ulp = 0x1p-23; // of 1
constexpr float infinity = std::numeric_limits<float>::infinity();
const Values natural = {{"model", 0}, {"strength", 1}};
const Values artistic = {{"model", 1}, {"strength", 1}};
const Values classic = {{"quality", "classic"}, {"model", 1}, {"strength", 1}};

Image gains(int width, int height, const Values& values) {
    return run_effect("vignette", {.color = constant(width, height, {1, 1, 1})}, values);
}

/// Largest rounding error of the gain. Natural: 4 ulp, of which the reciprocal may take 2.5. Artistic: the
/// same for the radius, which the cubic's steepest slope of 1.5 / softness then enlarges. Classic: pow may be
/// 16 ulp off, of at most 0.61.
double gain_tolerance(const Values& values) {
    if (values.contains("quality")) return 16 * ulp;
    const auto softness = values.find("softness");
    return values.at("model").number == 0
               ? 4 * ulp
               : (4 + 4 * 1.5 / (softness == values.end() ? 0.9 : softness->second.number)) * ulp;
}

} // namespace

TEST_CASE("the picture is the float64 reference's") {
    const Values cases[] = {{{"model", 0}},
                            natural,
                            {{"model", 1}},
                            artistic,
                            classic,
                            {{"quality", "classic"}, {"strength", 0.3}},
                            {{"model", 1}, {"strength", 1}, {"radius", 0}, {"softness", 0.01}},
                            {{"model", 1}, {"strength", 0.7}, {"roundness", 0}},
                            {{"model", 1}, {"strength", 0.7}, {"roundness", 0.4}, {"radius", 2}}};
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 40}, {40, 1}, {97, 61}, {64, 36}};
    for (const Values& values : cases) {
        for (const auto& [width, height] : sizes) {
            Input input{.color = noise(width, height, -5, 60)};
            for (double fov : {10.0, 45.0, 150.0}) {
                input.camera = Camera::perspective(fov, 0.1);
                const Worst worst = worst_difference(run_effect("vignette", input, values),
                                                     reference(reference_input("vignette", input, values)));
                INFO(width << "x" << height << " at " << fov << " degrees");
                CHECK(worst.absolute <= 60 * gain_tolerance(values));
            }
        }
    }
}

TEST_CASE("strength 0 changes no bit") {
    Image color = noise(33, 17, -5, 60);
    color.at(0, 0, 0) = -0.0f;
    color.at(1, 0, 1) = infinity;
    const std::uint32_t payload = 0x7fc12345u;
    std::memcpy(&color.at(2, 0, 2), &payload, sizeof(payload));
    for (Values values : {natural, artistic, classic}) {
        values["strength"] = 0;
        CHECK(same_bits(run_effect("vignette", {.color = color}, values), color));
        const Plan plan = plan_effect("vignette", {.color = color}, values);
        CHECK(plan.passes.empty());
        CHECK(plan.effects.at(0).moment == Moment::configuration);
    }
}

TEST_CASE("the natural gain is cos^4 to 4 ulp at any field of view, aspect and size") {
    const std::pair<int, int> sizes[] = {{640, 360}, {3840, 4}, {4, 2160}, {255, 257}};
    for (double fov : {5.0, 38.0, 90.0, 170.0}) {
        for (const auto& [width, height] : sizes) {
            Input input{.color = constant(width, height, {1, 1, 1}), .camera = Camera::perspective(fov, 0.1)};
            const Worst worst = worst_difference(run_effect("vignette", input, natural),
                                                 reference(reference_input("vignette", input, natural)));
            INFO(width << "x" << height << " at " << fov << " degrees");
            CHECK(worst.absolute <= 4 * ulp);
        }
    }
}

TEST_CASE("cos^4 is what arrives through a small aperture") {
    // Irradiance of a flat sensor under a Lambertian sky, seen through a disc of radius a at distance 1: the sum over
    // the aperture's elements of cos(at the element) cos(at the sensor) / distance^2.
    const double pi = std::acos(-1.0), a = 0.01;
    const auto irradiance = [&](double t) {
        double sum = 0;
        constexpr int rings = 16, sectors = 32;
        for (int i = 0; i < rings; ++i) {
            for (int j = 0; j < sectors; ++j) {
                const double r = a * std::sqrt((i + 0.5) / rings), angle = 2 * pi * (j + 0.5) / sectors;
                const double x = t - r * std::cos(angle), y = r * std::sin(angle);
                sum += 1 / std::pow(1 + x * x + y * y, 2);
            }
        }
        return sum;
    };
    Input input{.color = constant(101, 1, {1, 1, 1}), .camera = Camera::perspective(2, 0.1)};
    const Image image = run_effect("vignette", input, natural);
    for (int x : {0, 20, 40, 60}) {
        const double t = (2 * x + 1.0 - 101) * std::tan(pi / 180);
        CHECK(image.at(x, 0, 0) == Approx(irradiance(t) / irradiance(0)).epsilon(5e-4)); // a^2 times some
    }
}

TEST_CASE("classic is an ellipse and never negative") {
    const Image image = gains(160, 40, classic);
    // As far from the centre in pixels, but four times as far in texture coordinates.
    CHECK(image.at(80, 39, 0) == Approx(1 - std::pow(0.6, 3)).margin(0.02));
    CHECK(image.at(99, 20, 0) > 0.98f);
    CHECK(image.at(0, 0, 0) == Approx(1 - std::pow(1.2 * std::sqrt(0.5), 3)).margin(0.03));
    CHECK(*std::min_element(image.values.begin(), image.values.end()) > 0.38f);
}

TEST_CASE("a parallel projection has no natural falloff") {
    Input input{.color = noise(33, 17, -5, 60), .camera = Camera::parallel(10, 0.1, 100)};
    CHECK(same_bits(run_effect("vignette", input, natural), input.color));
    CHECK(plan_effect("vignette", input, natural).effects.at(0).moment == Moment::scene);
    CHECK(plan_effect("vignette", input, natural).effects.at(0).kind == SkipKind::exact);
    CHECK_FALSE(same_bits(run_effect("vignette", input, artistic), input.color));
}

TEST_CASE("the centre is untouched and the gain falls outwards, within 0..1") {
    for (double model : {0.0, 1.0}) {
        for (double strength : {0.001, 0.1, 1 / 3.0, 0.7, 1.0}) {
            const Values values = {{"model", model}, {"strength", strength}, {"radius", 0}};
            const Image image = gains(97, 61, values);
            CHECK(image.at(48, 30, 0) == 1.0f);
            bool falls = true, within = true;
            for (int x = 49; x < 97; ++x)
                falls = falls && image.at(x, 30, 0) <= image.at(x - 1, 30, 0);
            for (float gain : image.values)
                within = within && gain >= 0 && gain <= 1;
            CHECK(falls);
            CHECK(within);
            CHECK(image.at(96, 60, 0) < 1.0f);
        }
    }
    CHECK(gains(1, 1, natural).at(0, 0, 0) == 1.0f);
    CHECK(gains(1, 1, artistic).at(0, 0, 0) == 1.0f);
}

TEST_CASE("the gain is symmetric on the screen, whatever the picture's shape") {
    for (const Values& values : {natural, artistic}) {
        const int width = 64, height = 37;
        const Image image = gains(width, height, values);
        int mirrored = 0;
        double worst_turn = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                mirrored += image.at(x, y, 0) != image.at(width - 1 - x, y, 0);
                mirrored += image.at(x, y, 0) != image.at(x, height - 1 - y, 0);
            }
        }
        CHECK(mirrored == 0); // to the last bit
        const int side = 63;
        const Image wide = gains(side + 32, side, values);
        for (int b = 0; b < side / 2; ++b) {
            for (int a = 0; a < side / 2; ++a) {
                const double there = wide.at((side + 32) / 2 + a, side / 2 + b, 0);
                const double turned = wide.at((side + 32) / 2 + b, side / 2 + a, 0);
                worst_turn = std::max(worst_turn, std::abs(there - turned));
            }
        }
        CHECK(worst_turn <= 2 * gain_tolerance(values)); // the two directions round on their own
    }
}

TEST_CASE("twice the light gives twice the picture to the last bit") {
    const Image color = noise(41, 23, -5, 60);
    for (const Values& values : {Values{}, natural, artistic, classic}) {
        const Image once = run_effect("vignette", {.color = color}, values);
        for (float factor : {0x1p10f, 0x1p-10f}) {
            const Image result = run_effect("vignette", {.color = scaled(color, factor)}, values);
            CHECK(same_bits(result, scaled(once, factor)));
        }
    }
}

TEST_CASE("hostile pixels stay where they are, and no light times infinity is black") {
    Image color = constant(33, 33, {65504, -65504, 1e-40f});
    color.at(16, 16, 0) = infinity;
    color.at(0, 0, 0) = -infinity;
    color.at(32, 32, 0) = std::numeric_limits<float>::quiet_NaN();
    color.at(32, 0, 0) = infinity;
    const Values black_corners = {{"model", 1}, {"strength", 1}, {"radius", 0}, {"softness", 0.1}};
    for (const Values& values : {natural, black_corners}) {
        const Image result = run_effect("vignette", {.color = color}, values);
        int non_finite = 0;
        for (float value : result.values)
            non_finite += !std::isfinite(value);
        CHECK(non_finite == (values == natural ? 4 : 1));
        CHECK(result.at(16, 16, 0) == infinity);
        CHECK(result.at(32, 0, 0) == (values == natural ? infinity : 0.0f));
    }
}

TEST_CASE("with a shifted lens the gain is that of the part of a larger picture") {
    Input whole{.color = noise(192, 108, 0, 1), .camera = Camera::perspective(70, 0.1)};
    const Image wide = run_effect("vignette", whole, natural);
    for (const Part& part : {Part{96, 0, 96, 108}, Part{0, 54, 192, 54}, Part{7, 11, 31, 23}}) {
        const Input input = part_of(whole, part);
        const Image result = run_effect("vignette", input, natural);
        // Twice the gain's own rounding. Where the axis is, is rounded twice to float32, by up to 2^-23 of 4.9 half
        // heights; the gain changes by at most 1.1 for each half height's tangent of 0.7.
        const double margin = 8 * ulp + 4.9 * 0.7 * 1.1 * ulp;
        CHECK(worst_difference(result, convert<double>(part_of(three_channels(wide), part))).absolute
              <= margin);
        CHECK(worst_difference(result, reference(reference_input("vignette", input, natural))).absolute
              <= margin);
        Input centred = input;
        centred.camera.principal_point = {0, 0};
        CHECK_FALSE(same_bits(result, run_effect("vignette", centred, natural)));
        // Shapes of the picture, not of a lens, stay in its middle.
        for (const Values& values : {artistic, classic})
            CHECK(same_bits(run_effect("vignette", input, values), run_effect("vignette", centred, values)));
    }
}
