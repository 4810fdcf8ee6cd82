// Metrics: 0 for what is exact, as much as it is off for what is spoiled, and little for the effects' best levels.
#include "effect_method.hpp"

#include <cmath>
#include <numbers>

using namespace postfx::host;
using postfx::ChainEntry;
using postfx::Image64;
using postfx::testing::EffectMethod;
using postfx::testing::FunctionMethod;
using postfx::testing::measure;
using Draw = FunctionMethod::Function;

namespace {

double value(const ChainEntry& entry, const std::string& parameter) {
    return entry.values[*entry.effect->find_parameter(parameter)][0];
}

/// Every pixel from its place in picture heights from the centre, and its depth along the view axis.
using Pixel = std::function<double(const ChainEntry&, const MethodInput&, double x, double y, double z)>;
Draw every_pixel(const Pixel& pixel) {
    return [=](const ChainEntry& entry, const MethodInput& input) {
        const int width = input.color.width, height = input.color.height;
        const auto depth = input.attachments.find("depth");
        Image64 result(width, height, 3);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double z =
                    depth == input.attachments.end() ? 0 : input.camera.view_z(depth->second.at(x, y, 0));
                const double found =
                    pixel(entry, input, (x + 0.5 - 0.5 * width) / height, (y + 0.5) / height - 0.5, z);
                std::fill_n(result.pixel(x, y), 3, found);
            }
        }
        return result;
    };
}

Draw spoiled(const Draw& draw, double by) {
    return [=](const ChainEntry& entry, const MethodInput& input) {
        Image64 result = draw(entry, input);
        for (double& found : result.values)
            found -= by;
        return result;
    };
}

} // namespace

TEST_CASE("a wall's and a plane's occlusion") {
    const Draw open = every_pixel([](auto&&...) { return 1.0; });
    CHECK(measure("plane_error", FunctionMethod("ssao", open)) == 0);
    CHECK(measure("plane_error", FunctionMethod("ssao", spoiled(open, 0.03))) == Approx(0.03));

    // The fold is 5 m away and both sides rise at 45 degrees.
    const Draw wall = every_pixel([](const ChainEntry& entry, const MethodInput&, double, double, double z) {
        const double k = std::min((5 - z) * std::sqrt(2.0) / value(entry, "radius"), 1.0);
        return 1 - (std::acos(k) - k * std::sqrt(1 - k * k)) / std::numbers::pi;
    });
    CHECK(measure("wall_error", FunctionMethod("ssao", wall))
          < 1e-4); // the root at the foot of depths in float32
    CHECK(measure("wall_error", FunctionMethod("ssao", spoiled(wall, 0.05))) == Approx(0.05).margin(1e-4));
    CHECK(measure("wall_error", FunctionMethod("ssao", open)) > 0.1);

    const double best = measure("wall_error", EffectMethod("ssao", "reference"));
    CHECK(best < 0.02); // its 64 samples per side leave gaps
    CHECK(best < measure("wall_error", EffectMethod("ssao", "medium")));
    CHECK(measure("plane_error", EffectMethod("ssao", "medium")) <= 1.0 / 255);
    CHECK(measure("plane_error", EffectMethod("ssao", "classic")) > 0.1);
}

TEST_CASE("what comes through fog") {
    const Draw exact =
        every_pixel([](const ChainEntry& entry, const MethodInput& input, double x, double y, double z) {
            const double tall = 2 * input.camera.tan_half_fov(), falloff = value(entry, "height_falloff");
            const double length = z * std::sqrt(1 + tall * tall * (x * x + y * y)), rise = z * tall * y;
            const double eye = input.camera.view_to_world[13], lower = eye + std::min(rise, 0.0);
            const double t = falloff * std::abs(rise);
            const double mean = t > 0 ? -std::expm1(-t) / t : 1;
            return std::exp(-value(entry, "density") * std::exp(-falloff * lower) * length * mean);
        });
    CHECK(measure("transmittance_error", FunctionMethod("fog", exact))
          < 1e-12); // roundings of heights up to 100 km
    CHECK(measure("transmittance_error", FunctionMethod("fog", spoiled(exact, 0.01)))
          == Approx(0.01).margin(1e-6));
    // Two uses of float32's exponential, and heights to the rounding of their distance.
    CHECK(measure("transmittance_error", EffectMethod("fog", "medium")) < 2e-5);
    CHECK(measure("transmittance_error", EffectMethod("fog", "classic")) > 0.1);
}

TEST_CASE("a vignette's gain") {
    const Draw exact =
        every_pixel([](const ChainEntry&, const MethodInput& input, double x, double y, double) {
            return std::pow(std::cos(std::atan(2 * input.camera.tan_half_fov() * std::hypot(x, y))), 4);
        });
    CHECK(measure("gain_error", FunctionMethod("vignette", exact)) < 1e-14);
    CHECK(measure("gain_error", FunctionMethod("vignette", spoiled(exact, 0.02))) == Approx(0.02));
    CHECK(measure("gain_error", EffectMethod("vignette", "medium")) < 4 * 0x1p-23);
    CHECK(measure("gain_error", EffectMethod("vignette", "classic")) > 0.1);
}

TEST_CASE("a sphere's rim") {
    // The sphere's centre is 3 m away.
    const Draw exact =
        every_pixel([](const ChainEntry& entry, const MethodInput& input, double x, double y, double) {
            const double cosine = std::sqrt(1 - std::pow(input.camera.vertical_extent, 2) * (x * x + y * y));
            if (std::isnan(cosine)) return 0.0;
            if (value(entry, "profile") == 0) return std::max(1 - cosine / value(entry, "width"), 0.0);
            const double in = std::acos(cosine), out = std::asin(std::sin(in) / 1.5);
            return (std::pow(std::sin(in - out) / std::sin(in + out), 2)
                    + std::pow(std::tan(in - out) / std::tan(in + out), 2))
                   / 2;
        });
    CHECK(measure("sphere_error", FunctionMethod("rim_light", exact)) < 1e-12);
    CHECK(measure("sphere_error", FunctionMethod("rim_light", spoiled(exact, 0.02))) == Approx(0.02));
    CHECK(measure("sphere_error", EffectMethod("rim_light", "medium")) < 1e-5);
    // 750 pixels on the circle, each 0.3 off at random.
    CHECK(measure("mean_error", FunctionMethod("rim_light", exact)) < 1e-3);
    CHECK(measure("mean_error", FunctionMethod("rim_light", spoiled(exact, 0.02))) > 0.015);
    CHECK(measure("mean_error", EffectMethod("rim_light", "medium")) < 1e-3);
}

TEST_CASE("tone curves") {
    // The curves' points are in the truth's test; here it is enough that the effect has them.
    const Draw run = [](const ChainEntry& entry, const MethodInput& input) {
        postfx::testing::Values values;
        for (std::size_t i = 0; i < entry.values.size(); ++i)
            values[entry.effect->parameters[i].id] = entry.values[i][0];
        return postfx::convert<double>(postfx::testing::three_channels(
            postfx::testing::run_effect("tonemap", {.color = input.color}, values)));
    };
    CHECK(measure("curve_error", FunctionMethod("tonemap", run)) < 16 * 0x1p-23);
    CHECK(measure("curve_error", FunctionMethod("tonemap", spoiled(run, 0.01))) == Approx(0.01).margin(1e-5));
}
