// Truths of rim light on a sphere, against closed forms.
#include <catch2/catch.hpp>

#include <truth_of.hpp>

#include <cmath>
#include <numbers>

using namespace postfx::host;
using namespace postfx::testing;
using postfx::Image64;

namespace {

constexpr double pi = std::numbers::pi;

const std::string white = "materials:\n  white: {diffuse: 1, specular: 0}\n";
/// A sphere of radius 1 fills 0.8 of the picture's width.
const std::string ball = white + R"(
camera: {position: [0, 0, 5], look_at: [0, 0, 0], orthographic_extent: 2.5, near: 0.5, far: 100}
nodes:
  - {mesh: {sphere: {radius: 1, segments: 256}}, material: white}
)";

} // namespace

TEST_CASE("a sphere's rim has the mean of its closed form, from its normals and from its surface") {
    constexpr int size = 100;
    const double pixels_of_disc = pi * 40 * 40;
    for (const double width : {0.25, 1.0, 2.0}) {
        const double mean = width <= 1 ? width * width / 3 : 1 - 2 / (3 * width);
        for (const char* kind : {"layer", "scene"}) {
            const bool is_scene = std::string(kind) == "scene";
            const TruthResult result = truth_in("rim_light", ball, kind, size, is_scene ? 64 : 2,
                                                {{"width", width}, {"strength", 2}, {"color", 1}}, 0);
            double sum = 0;
            for (std::size_t i = 0; i < result.picture.values.size(); i += 3)
                sum += result.picture.values[i] / 2;
            INFO(kind << ", width " << width);
            // One normal per pixel counts the rim's in whole pixels: 250 on the circle, each 0.3 off at random. 64
            // rays leave the corners of 256 segments: 1e-4.
            CHECK(sum / pixels_of_disc == Approx(mean).margin(is_scene ? 3e-4 : 4e-3));
            // On the circle, a pixel is half rim and half nothing: 64 rays in two dimensions.
            CHECK(result.own_error < (is_scene ? 0.06 : 12 * 0x1p-53));
        }
    }
}

TEST_CASE("each pixel of a sphere has the rim of its angle") {
    constexpr int size = 100;
    const double index = 1.5;
    for (const bool mirrors : {false, true}) {
        const Numbers values = {
            {"width", 0.7}, {"profile", mirrors}, {"refractive_index", index}, {"strength", 1}, {"color", 1}};
        const Image64 layer = truth_in("rim_light", ball, "layer", size, 2, values, 0.5).picture;
        const Image64 scene = truth_in("rim_light", ball, "scene", size, 256, values, 0.5).picture;
        for (int x = 12; x < 88; x += 3) {
            const double cosine = std::sqrt(1 - (std::pow(x - 49.5, 2) + 0.25) / 1600);
            const double in = std::acos(cosine), out = std::asin(std::sin(in) / index);
            const double fresnel = (std::pow(std::sin(in - out) / std::sin(in + out), 2)
                                    + std::pow(std::tan(in - out) / std::tan(in + out), 2))
                                   / 2;
            const double share = mirrors ? fresnel : std::max(1 - cosine / 0.7, 0.0);
            INFO("column " << x << (mirrors ? ", fresnel" : ", ramp"));
            // Normals are half floats, off by 5e-4, times the slope; the mean over a pixel bends by that over its
            // width.
            CHECK(layer.at(x, 50, 1) == Approx(0.5 + share).margin(3e-3));
            CHECK(scene.at(x, 50, 1) == Approx(0.5 + share).margin(5e-3));
        }
        CHECK(layer.at(2, 2, 0) == 0.5);
        CHECK(scene.at(2, 2, 0) == 0.5);
    }
}
