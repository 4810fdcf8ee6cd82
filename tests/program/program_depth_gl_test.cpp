// postfx apply on depth, cameras and normals of many conventions.
#include "program.hpp"

#include <base/projection_matrix.hpp>
#include <image/files.hpp>
#include <image/joint_bilateral.hpp>

#include <reduced_depth.hpp>
#include <testing.hpp>

#include <fmt/format.h>

#include <cmath>
#include <functional>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr int width = 48, height = 32;
const std::string fog = "fog: {density: 0.05, height_falloff: 0, color: [0, 0, 0]}";

/// Metres along the view axis; nothing in the upper right.
double distance(int x, int y) {
    return x > 30 && y > 20 ? 0 : 2 + 0.3 * x + 0.1 * y;
}

Image made(const std::function<double(int, int)>& value) {
    Image image(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            image.at(x, y, 0) = static_cast<float>(value(x, y));
    }
    return image;
}

/// A folder with a white picture, and what `apply` makes of it.
class Case {
public:
    Case() {
        write_image(path("c.pfm"), Image(width, height, 3, 1.0f));
        save("z.pfm", made(distance));
    }
    std::string path(const std::string& name) const { return directory_ / name; }
    void save(const std::string& name, const Image& image, bool half = false) const {
        write_image(path(name), image, {.half = half});
    }
    Outcome run(const std::string& effect, std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"apply", "--no-times", "--color", path("c.pfm"), "--effect",
                                             effect, "-o", path("out.pfm")});
        return run_program(arguments, directory_.path());
    }
    /// The picture; it must work, and tell `words` on stderr, or nothing.
    Image picture(const std::string& effect, const std::vector<std::string>& arguments,
                  const std::string& words = "") const {
        const Outcome outcome = run(effect, arguments);
        INFO(outcome.err);
        REQUIRE(outcome.status == 0);
        if (words.empty())
            CHECK(outcome.err.empty());
        else
            CHECK_THAT(outcome.err, Catch::Contains(words));
        return read_image(path("out.pfm")).image;
    }

private:
    TemporaryDirectory directory_;
};

double worst(const Image& a, const Image& b) {
    return worst_difference(a, convert<double>(b)).absolute;
}

std::vector<std::string> with_matrix(std::vector<std::string> arguments, const ProjectionMatrix& matrix) {
    arguments.emplace_back("--projection");
    for (const double entry : matrix)
        arguments.push_back(fmt::format("{}", entry));
    return arguments;
}

/// Light changes by at most 0.05 / m times the error of a distance: of a float of up to 20 m, and of 0.1 / z, 5e-6 m.
constexpr double rounding = 1e-6;

} // namespace

TEST_CASE("Every kind of depth gives the same picture") {
    const Case test;
    const Image expected = test.picture(fog, {"--depth", "z.pfm"});
    const auto same = [&](const std::string& name, const std::function<double(int, int)>& value,
                          std::vector<std::string> arguments) {
        test.save(name, made(value));
        arguments.insert(arguments.begin(), {"--depth", name});
        INFO(name);
        CHECK(worst(test.picture(fog, arguments), expected) < rounding);
    };
    same("inverse.pfm", [](int x, int y) { return distance(x, y) > 0 ? 1 / distance(x, y) : 0; },
         {"--depth-kind", "inverse"});
    same("centimetres.pfm", [](int x, int y) { return distance(x, y) > 0 ? 0.01 / distance(x, y) : 0; },
         {"--depth-kind", "inverse", "--depth-unit", "0.01"});
    // Dioptres from 0.02 to 0.6; what is nearer to 0 than that is given as nothing.
    const auto disparity = [](double at0, double at1) {
        return [=](int x, int y) {
            return distance(x, y) > 0 ? (1 / distance(x, y) - at0) / (at1 - at0) : std::nan("");
        };
    };
    same("disparity.pfm", disparity(0.02, 0.6),
         {"--depth-kind", "disparity", "--disparity-range", "0.02", "0.6"});
    same("falling.pfm", disparity(0.6, 0), {"--depth-kind", "disparity", "--disparity-range", "0.6", "0"});
    same("flipped.pfm", [](int x, int y) { return distance(x, height - 1 - y); }, {"--depth-flip"});
    same("far.pfm", [](int x, int y) { return distance(x, y) > 0 ? distance(x, y) : 1e30; },
         {"--depth-nothing", "1e30"});
}

TEST_CASE("A sample that means nothing is found in the file's own precision") {
    const Case test;
    const Image expected = test.picture(fog, {"--depth", "z.pfm"});
    for (const double nothing : {1e12, 1e30, 999.9}) {
        const Image depth = made([&](int x, int y) { return distance(x, y) > 0 ? distance(x, y) : nothing; });
        test.save("far.pfm", depth);
        test.save("far.exr", depth);
        for (const char* file : {"far.pfm", "far.exr"}) {
            const Image found =
                test.picture(fog, {"--depth", file, "--depth-nothing", fmt::format("{}", nothing)});
            CHECK(found.values == expected.values);
        }
    }
    // Half floats: 999.9 is 1000 there.
    test.save("half.exr", made([](int x, int y) { return distance(x, y) > 0 ? 4.0 : 999.9; }), true);
    const Image half = test.picture(fog, {"--depth", "half.exr", "--depth-nothing", "999.9"});
    CHECK(half.at(40, 30, 0) == 1.0f);
    CHECK(half.at(0, 0, 0) < 0.9f);
    test.picture(fog, {"--depth", "z.pfm", "--depth-nothing", "777"}, "no sample is 777 (--depth-nothing)");
    // Of window depth too.
    test.save("window.pfm", made([](int x, int y) { return x > 30 && y > 20 ? 0.25 : 0.9; }));
    const Image window = test.picture(
        fog, {"--depth", "window.pfm", "--depth-kind", "window", "--far", "100", "--depth-nothing", "0.25"});
    CHECK(window.at(40, 30, 0) == 1.0f);
    CHECK(window.at(0, 0, 0) < 1.0f);
}

TEST_CASE("An off-centre projection is the part of a larger picture") {
    const Case test;
    constexpr ProjectionMatrix centred = {1, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0};
    ProjectionMatrix half = centred, shifted = centred;
    half[0] = 2; // the right half of a picture of that size, in as many pixels
    half[5] = 3;
    half[8] = 1;
    shifted[8] = 0.5;
    const std::string vignette = "vignette: {strength: 1}";
    for (const char* kind : {"window-reversed-infinite", "z", "distance"}) {
        const std::vector<std::string> arguments = {"--depth", "z.pfm", "--depth-kind", kind};
        const Image there = test.picture(vignette, with_matrix(arguments, centred));
        const Image moved = test.picture(vignette, with_matrix(arguments, shifted));
        // The axis has gone left by a quarter of the picture, and with it all but the last quarter.
        double difference = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width * 3 / 4; ++x)
                difference =
                    std::max(difference, std::abs(static_cast<double>(moved.at(x, y, 0))
                                                  - static_cast<double>(there.at(x + width / 4, y, 0))));
        }
        CHECK(difference < 1e-6);
    }
    // In the right upper quarter, whose axis is in its lower left corner, fog follows rays from there: distances.
    half[9] = 1;
    const Image part = test.picture(fog, with_matrix({"--depth", "z.pfm"}, half));
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{29, 20}, std::pair{47, 0}, std::pair{0, 31}}) {
        const double right = (x + 0.5) / width, up = (y + 0.5) / height / 1.5;
        const double ray = distance(x, y) * std::sqrt(1 + right * right + up * up);
        CHECK(part.at(x, y, 0) == Approx(std::exp(-0.05 * ray)).margin(2 * rounding));
    }
    // Parallel rays have the same vignette anywhere, and a matrix of their own.
    const ProjectionMatrix parallel = {0.1, 0, 0, 0, 0, 0.15, 0, 0, 0, 0, -0.02, 0, 0.3, 0, -1, 1};
    CHECK(test.picture(vignette, with_matrix({"--depth", "z.pfm"}, parallel)).values
          == std::vector<float>(width * height * 3, 1.0f));
    ProjectionMatrix mirrored = shifted;
    mirrored[5] = -1.5;
    check_refused(test.run(fog, with_matrix({"--depth", "z.pfm"}, mirrored)),
                  "mirrors the picture upside down");
    mirrored[5] = 3;
    check_refused(test.run(fog, with_matrix({"--depth", "z.pfm"}, mirrored)), "times as wide as high");
}

TEST_CASE("Depth of another size is brought to the picture's, and a line says so") {
    const Case test;
    const Image expected = test.picture(fog, {"--depth", "z.pfm"});
    Image half(width / 2, height / 2, 1), twice(2 * width, 2 * height, 1);
    for (int y = 0; y < height / 2; ++y) {
        for (int x = 0; x < width / 2; ++x)
            half.at(x, y, 0) = static_cast<float>(distance(2 * x, 2 * y) > 0 ? 2.2 + 0.6 * x + 0.2 * y : 0);
    }
    for (int y = 0; y < 2 * height; ++y) {
        for (int x = 0; x < 2 * width; ++x)
            twice.at(x, y, 0) = static_cast<float>(distance(x / 2, y / 2));
    }
    test.save("half.pfm", half);
    test.save("twice.pfm", twice);
    const Image smaller = test.picture(fog, {"--depth", "half.pfm"},
                                       "half.pfm: the depth is 24x16, the picture 48x32: brought");
    // Nothing tells where the surface ends in a white picture; elsewhere it is even. Half a map's pixel of a slope of
    // 0.3 m a pixel is not extrapolated beyond the border.
    for (const auto& [x, y] : {std::pair{5, 5}, std::pair{20, 25}, std::pair{40, 10}, std::pair{44, 28}})
        CHECK(smaller.at(x, y, 0) == Approx(expected.at(x, y, 0)).margin(0.02));
    CHECK(smaller.at(44, 28, 0) == 1.0f);
    CHECK(
        test.picture(fog, {"--depth", "twice.pfm"}, "twice.pfm: the depth is 96x64, the picture 48x32: each")
            .values
        == expected.values);
    check_refused(test.run(fog, {"--depth", "half.pfm", "--strict"}), "--strict");
    test.save("wide.pfm", Image(40, 20, 1, 1.0f));
    check_refused(test.run(fog, {"--depth", "wide.pfm"}), "wide.pfm: is 40x20, which is not the shape");
    test.save("rounded.pfm", Image(width / 5, height / 5, 1, 1.0f)); // 9.6 x 6.4, rounded down
    test.picture(fog, {"--depth", "rounded.pfm"}, "is 9x6");
}

TEST_CASE("Depth of a scene reduced 4 to 8 times keeps its edges") {
    const TemporaryDirectory directory;
    for (const std::string scene : {"still_life", "night_drive"}) {
        const std::string color = directory / (scene + ".pfm"), depth = directory / (scene + ".depth.pfm");
        const Outcome rendered = run_program({"render", scene, "-q", "--no-times", "--chain", "none",
                                              "--size", "1280x720", "--save", "depth=" + depth, "-o", color});
        INFO(rendered.err);
        REQUIRE(rendered.status == 0);
        const Image picture = read_image(color).image;
        Image truth = read_image(depth, {.role = Role::depth}).image;
        for (float& value : truth.values)
            value = value > 0 ? 1 / value : 0;
        for (const int factor : {4, 8}) {
            const Image reduced = nearest_values(truth, 1280 / factor, 720 / factor);
            const DepthError joint = depth_error(joint_bilateral(reduced, picture), truth);
            const DepthError nearest = depth_error(nearest_values(reduced, 1280, 720), truth);
            const DepthError bilinear = depth_error(bilinear_values(reduced, 1280, 720), truth);
            const auto text = [](const DepthError& e) {
                return fmt::format("wrong {:.4f}, nothing {:.4f}, mean {:.4f}", e.wrong, e.nothing, e.mean);
            };
            INFO(scene << " reduced " << factor << " times: joint " << text(joint) << "; nearest "
                       << text(nearest) << "; bilinear " << text(bilinear));
            // What is left is thinner than the map's pixels or has its background's colour: in the dark, more. The
            // figures are in docs/images-from-elsewhere.md; these bounds leave a tenth for other rasterisers.
            CHECK(joint.wrong < 0.78 * nearest.wrong);
            CHECK(joint.wrong < 0.48 * bilinear.wrong);
            CHECK(joint.nothing < 0.5 * nearest.nothing);
            CHECK(joint.nothing < 0.25 * bilinear.nothing);
            CHECK(joint.mean < 0.74 * nearest.mean);
            CHECK(joint.mean < 0.58 * bilinear.mean);
        }
    }
}

TEST_CASE("Depth of three different channels is refused, whatever the format") {
    const TemporaryDirectory scratch;
    const std::string picture = (scratch / "picture.pfm").string(), depth = (scratch / "depth.pfm").string();
    write_image(picture, Image(8, 6, 3, 0.5f));
    Image colors(8, 6, 3, 5);
    const auto run = [&] {
        write_image(depth, colors);
        return run_program({"apply", "--color", picture, "--depth", depth, "--chain", "none", "-o",
                            (scratch / "out.pfm").string()});
    };
    CHECK(run().status == 0);
    colors.at(3, 2, 1) = 6;
    check_refused(run(), "three different channels");
}

TEST_CASE("Numbers that are none, and options that contradict each other, are refused") {
    const Case test;
    const auto refused = [&](std::vector<std::string> arguments, const std::string& words) {
        arguments.insert(arguments.begin(), {"--depth", "z.pfm"});
        check_refused(test.run(fog, arguments), words);
    };
    for (const char* option : {"--depth-unit", "--fov", "--focal-length", "--sensor-height", "--orthographic",
                               "--near", "--far", "--time"}) {
        refused({option, "nan"}, option);
        refused({option, "inf"}, option);
    }
    refused({"--depth-kind", "disparity"}, "--disparity-range");
    refused({"--disparity-range", "0", "1"}, "--depth-kind disparity");
    refused({"--depth-kind", "disparity", "--disparity-range", "1", "1"}, "twice the same");
    refused({"--depth-kind", "disparity", "--disparity-range", "nan", "1"}, "--disparity-range");
    refused({"--depth-kind", "disparity", "--disparity-range", "-1", "1"}, "--disparity-range");
    refused({"--depth-kind", "window", "--far", "10", "--depth-unit", "2"}, "--depth-unit");
    refused({"--sensor-height", "24"}, "--focal-length");
}

TEST_CASE("Normals of world space are turned by the matrix that is given") {
    const Case test;
    Image view(width, height, 3), world(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double a = 0.02 * (x - 24), b = 0.02 * (y - 16), c = std::sqrt(1 - a * a - b * b);
            const float seen[] = {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
            const float turned[] = {static_cast<float>(-a), static_cast<float>(b), static_cast<float>(-c)};
            std::copy_n(seen, 3, view.pixel(x, y));
            std::copy_n(turned, 3, world.pixel(x, y));
        }
    }
    test.save("view.exr", view);
    test.save("world.exr", world);
    const std::string rim = "rim_light: {strength: 1, color: 1, width: 1}";
    const Image expected = test.picture(rim, {"--normal", "view.exr"});
    // A camera that looks along the world's +z.
    std::vector<std::string> turned = {"--normal", "world.exr", "--normal-space", "world",
                                       "--world-to-camera"};
    for (const int entry : {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 3, 4, 5, 1})
        turned.push_back(std::to_string(entry));
    CHECK(worst(test.picture(rim, turned, "world space"), expected) < 1e-6);
    turned.emplace_back("--strict");
    check_refused(test.run(rim, turned), "--strict");
    test.picture(rim, {"--normal", "world.exr"}, "--normal-space world");
    check_refused(test.run(rim, {"--normal", "world.exr", "--normal-space", "world"}), "--world-to-camera");
}
