// The program on data that nobody here made. Looks for it in $POSTFX_TEST_DATA, then in ../shared/data beside the source
// tree; where there is none it says so and passes.
#include "program.hpp"

#include <image/files.hpp>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

namespace fs = std::filesystem;
using namespace postfx;
using namespace postfx::testing;

namespace {

/// The data file's path, or "" after saying that it is absent.
std::string data(const std::string& name) {
    const char* named = std::getenv("POSTFX_TEST_DATA");
    const fs::path folder = named ? fs::path(named) : fs::path(POSTFX_SOURCE_DIRECTORY) / "../shared/data";
    if (fs::exists(folder / name)) return (folder / name).string();
    std::cout << "skipped: " << name << " is not there (POSTFX_TEST_DATA names its folder)\n";
    return "";
}

struct Brightness {
    double mean = 0, largest = 0;
    bool finite = true;
};

Brightness brightness(const Image& image) {
    Brightness result;
    for (float value : image.values) {
        result.finite = result.finite && std::isfinite(value);
        result.mean += value;
        result.largest = std::max(result.largest, static_cast<double>(value));
    }
    result.mean /= static_cast<double>(image.values.size());
    return result;
}

} // namespace

TEST_CASE("model files render through the default chain") {
    const std::string model = data(GENERATE("FlightHelmet/FlightHelmet.gltf", "cornell_box/cornell_box.obj"));
    if (model.empty()) return;
    const TemporaryDirectory scratch;
    const Outcome outcome = run_program({"render", model, "--chain", "cinematic", "--size", "320x180", "-o",
                                         (scratch / "model.exr").string()});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Brightness seen = brightness(read_image((scratch / "model.exr").string()).image);
    CHECK(seen.finite);
    CHECK(seen.mean > 0.02); // lit, and not burnt out: tone mapped light lies in 0..1
    CHECK(seen.mean < 0.7);
    CHECK(seen.largest <= 1.0);
}

TEST_CASE("an EXR with its own Z gets depth of field") {
    const std::string exr = data("images/beachball.0001.exr");
    if (exr.empty()) return;
    const TemporaryDirectory scratch;
    const Outcome outcome = run_program({"apply", "--color", exr, "--depth", exr, "--fov", "35", "--effect",
                                         "depth_of_field: {focus_distance: 5, f_number: 1.4}", "-o",
                                         (scratch / "ball.exr").string()});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Image before = read_image(exr).image, after = read_image((scratch / "ball.exr").string()).image;
    REQUIRE(after.width == before.width);
    REQUIRE(after.height == before.height);
    const Brightness was = brightness(before), is = brightness(after);
    CHECK(is.finite);
    // A lens moves light about and makes none; the picture's border and the largest circle lose or gain a little.
    CHECK(is.mean == Approx(was.mean).epsilon(0.02));
    CHECK(before.values != after.values);
}

TEST_CASE("an HDR panorama glows and keeps its energy") {
    const std::string hdr = data("images/night.hdr");
    if (hdr.empty()) return;
    const TemporaryDirectory scratch;
    const Outcome outcome = run_program({"apply", "--color", hdr, "--effect", "bloom: {intensity: 0.2}", "-o",
                                         (scratch / "night.pfm").string()});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Brightness was = brightness(read_image(hdr).image),
                     is = brightness(read_image((scratch / "night.pfm").string()).image);
    CHECK(is.finite);
    CHECK(is.mean == Approx(was.mean).epsilon(0.02)); // what leaves at the border comes back clamped
    CHECK(is.largest < was.largest);
}

// NVlabs/flip, images/reference.png and test.png (BSD-3-Clause), put there as flip/reference.png and flip/test.png.
TEST_CASE("FLIP of its authors' pair of pictures is what they publish") {
    const std::string reference = data("flip/reference.png"), test = data("flip/test.png");
    if (reference.empty() || test.empty()) return;
    const Outcome outcome = run_program({"diff", reference, test, "--flip", "--json"});
    INFO(outcome.err);
    const double mean = nlohmann::json::parse(outcome.out)["flip"]["mean"].get<double>();
    CHECK(mean == Approx(0.159691).margin(2e-6)); // theirs is float32; they say that the last digits differ
}
