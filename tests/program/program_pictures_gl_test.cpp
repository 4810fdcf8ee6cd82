// postfx apply on pictures: what becomes of alpha, what is written, photographs and where they are focused.
#include "program.hpp"

#include <exr_files.hpp>
#include <jpeg_segments.hpp>
#include <testing.hpp>

#include <image/files.hpp>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

using namespace postfx;
using namespace postfx::testing;

namespace {

Outcome apply(const TemporaryDirectory& directory, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"apply", "--no-times"});
    return run_program(arguments, directory.path());
}

/// `apply --chain none`, quiet, which must work.
Image passed(const TemporaryDirectory& directory, const std::string& from, const std::string& to,
             std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"-q", "--color", from, "--chain", "none", "-o", to});
    const Outcome outcome = apply(directory, more);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return read_image(directory / to).image;
}

/// White, half covered.
Image half_white(float light) {
    Image image(2, 1, 4);
    image.values = {light, light, light, 0.5f, 0.25f, 0.25f, 0.25f, 1.0f};
    return image;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// Alpha is 128 of 255 in a PNG, not a half: what is divided or multiplied by it is off by 1 / 255 of itself.
constexpr double coded_half = 1 / 255.0;

} // namespace

TEST_CASE("An EXR's light is multiplied by alpha, a PNG's is not") {
    const TemporaryDirectory directory;
    write_image(directory / "half.exr", half_white(0.5f));
    const Image straight = passed(directory, "half.exr", "half.png");
    CHECK(straight.at(0, 0, 0) == 1);
    CHECK(straight.at(0, 0, 3) == 128 / 255.0f);
    // Sixteen bits are divided on the CPU, eight in the last pass.
    CHECK(passed(directory, "half.exr", "deep.png", {"--bits", "16"}).at(0, 0, 0) == 1);
    CHECK(read_image(directory / "deep.png").coding.bits == 16);
    const Image multiplied = passed(directory, "half.png", "back.exr");
    CHECK(multiplied.at(0, 0, 0) == Approx(0.5).epsilon(2 * coded_half));
    CHECK(multiplied.at(1, 0, 0)
          == Approx(0.25).epsilon(0.01)); // an 8-bit code of sRGB there is 1 % of the light
    // From like to like nothing is computed.
    CHECK(passed(directory, "half.exr", "same.exr").values == half_white(0.5f).values);
    CHECK(passed(directory, "half.png", "same.png").values == straight.values);
}

TEST_CASE("--alpha says otherwise, and what has no alpha says so") {
    const TemporaryDirectory directory;
    write_image(directory / "half.exr", half_white(0.5f));
    CHECK(passed(directory, "half.exr", "raw.png", {"--alpha", "premultiplied"}).at(0, 0, 0)
          == Approx(0.5).epsilon(0.01));
    CHECK(passed(directory, "half.exr", "straight.exr", {"--alpha", "straight"}).at(0, 0, 0) == 1);
    CHECK(passed(directory, "half.exr", "none.png", {"--alpha", "drop"}).channels == 3);
    for (const char* file : {"out.pfm", "out.jpg", "out.hdr"}) {
        INFO(file);
        const std::vector<std::string> arguments = {"-q",   "--color", "half.exr", "--chain",
                                                    "none", "-o",      file};
        const Outcome told = apply(directory, arguments);
        CHECK(told.status == 0);
        CHECK_THAT(told.err, Catch::Contains("has no alpha"));
        std::vector<std::string> more = arguments;
        more.insert(more.end(), {"--alpha", "drop", "--strict"});
        CHECK(apply(directory, more).err.empty());
        more = arguments;
        more.emplace_back("--strict");
        check_refused(apply(directory, more), "has no alpha");
        more = arguments;
        more.insert(more.end(), {"--alpha", "straight"});
        check_refused(apply(directory, more), "has no alpha");
    }
    // Covered wholly there is nothing to tell.
    write_image(directory / "whole.exr", Image(2, 1, 4, 1.0f));
    CHECK(apply(directory, {"-q", "--color", "whole.exr", "--chain", "none", "-o", "out.pfm"}).err.empty());
}

TEST_CASE("JPEG by quality, and bits for PNG alone") {
    const TemporaryDirectory directory;
    write_image(directory / "noise.pfm", noise(64, 64, 0, 1));
    const Image best = passed(directory, "noise.pfm", "best.jpg", {"--quality", "1"});
    passed(directory, "noise.pfm", "worst.jpeg", {"--quality", "0.1"});
    CHECK(bytes_of(directory / "worst.jpeg").size() < bytes_of(directory / "best.jpg").size() / 4);
    CHECK(best.width == 64);
    check_refused(
        apply(directory, {"--color", "noise.pfm", "--chain", "none", "-o", "a.exr", "--bits", "16"}),
        "--bits 16 is for a PNG");
}

TEST_CASE("The camera is focused on what is seen at a place") {
    const TemporaryDirectory directory;
    // Rows from the bottom: 2 m below, 8 m above, nothing in the upper right corner.
    Image depth(40, 40, 1);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            depth.at(x, y, 0) = y < 20 ? 2.0f : x < 30 ? 8.0f : 0.0f;
    depth.at(10, 10, 0) = 100; // one wrong sample does not decide
    write_image(directory / "z.pfm", depth);
    write_image(directory / "c.pfm", noise(40, 40, 0, 1));
    const auto out = [&](const std::string& file, std::vector<std::string> more) {
        more.insert(more.begin(), {"--color", "c.pfm", "--depth", "z.pfm", "-o", file});
        return apply(directory, more);
    };
    const auto blurred = [](double distance) {
        return fmt::format("depth_of_field: {{f_number: 1, focal_length: 100, focus_distance: {}}}",
                           distance);
    };
    CHECK_THAT(out("at.pfm", {"--effect", blurred(0), "--focus-at", "0.27,0.74"}).err,
               Catch::Contains("focused 2 m away"));
    REQUIRE(out("told.pfm", {"--effect", blurred(2)}).status == 0);
    CHECK(read_image(directory / "at.pfm").image.values == read_image(directory / "told.pfm").image.values);
    // From the top left.
    CHECK_THAT(out("at.pfm", {"--effect", blurred(0), "--focus-at", "0.1,0.1"}).err,
               Catch::Contains("focused 8 m away"));
    check_refused(out("at.pfm", {"--effect", blurred(0), "--focus-at", "0.99,0.01"}), "no surface");
    for (const char* wrong : {"0.5", "0.5,1.5", "nan,0", "0.5,0.5,0.5", "a,b"})
        check_refused(out("at.pfm", {"--effect", blurred(0), "--focus-at", wrong}), "--focus-at");
    check_refused(apply(directory,
                        {"--color", "c.pfm", "--effect", blurred(0), "--focus-at", "0.5,0.5", "-o", "a.pfm"}),
                  "needs a depth");
}

TEST_CASE("A photograph tells its field of view, and maps are turned with it") {
    const TemporaryDirectory directory;
    write_image(directory / "stored.jpg", Image(48, 32, 3, 0.5f), {.quality = 1});
    write_bytes(directory / "photo.jpg",
                with_segments(bytes_of(directory / "stored.jpg"), exif_segment(6, 1)));
    const std::string vignette = "vignette: {strength: 1}";
    REQUIRE(apply(directory, {"-q", "--color", "photo.jpg", "--effect", vignette, "-o", "own.pfm"}).status
            == 0);
    const Image own = read_image(directory / "own.pfm").image;
    CHECK(own.width == 32);
    CHECK(own.height == 48);
    // 26 mm on the 43.27 mm diagonal of 35 mm film, of which the upright picture's height is 48 of hypot(32, 48).
    const double half = std::hypot(36, 24) / 2 * 48 / std::hypot(32, 48);
    const double fov = 2 * std::atan(half / 26) * 180 / std::numbers::pi;
    REQUIRE(apply(directory, {"-q", "--color", "photo.jpg", "--fov", fmt::format("{:.17g}", fov), "--effect",
                              vignette, "-o", "told.pfm"})
                .status
            == 0);
    CHECK(worst_difference(own, convert<double>(read_image(directory / "told.pfm").image)).absolute
          < 1e-6); // a float's rounding
    // The depth as the sensor saw it: its left edge, 2 m away, is the upright picture's upper one.
    Image depth(48, 32, 1, 50.0f);
    for (int y = 0; y < 32; ++y)
        depth.at(0, y, 0) = 2;
    write_image(directory / "z.pfm", depth);
    REQUIRE(apply(directory, {"-q", "--color", "photo.jpg", "--depth", "z.pfm", "--effect",
                              "fog: {density: 1, height_falloff: 0, color: [0, 0, 0]}", "-o", "fogged.pfm"})
                .status
            == 0);
    const Image fogged = read_image(directory / "fogged.pfm").image;
    for (int x = 0; x < 32; ++x) {
        CHECK(fogged.at(x, 47, 0) > 0.01f);
        CHECK(fogged.at(x, 20, 0) < 1e-6f);
    }
}

TEST_CASE("One pipe gives the colour and its depth") {
    const TemporaryDirectory directory;
    write_scanlines(directory / "a.exr", header_of(box(0, 0, 7, 5), box(0, 0, 7, 5)), {"R", "G", "B", "Z"});
    const auto with = [&](const std::string& name, const std::string& out) {
        const std::string command =
            fmt::format("cat a.exr | " POSTFX_BUILD_DIRECTORY
                        "/postfx apply -q --color {0} --depth {0} --effect 'fog: {{density: 1e-4}}' -o {1}",
                        name, out);
        return run_command({"bash", "-c", command}, directory.path());
    };
    REQUIRE(with("a.exr", "file.pfm").status == 0);
    const Outcome piped = with("-", "pipe.pfm");
    INFO(piped.err);
    REQUIRE(piped.status == 0);
    CHECK(read_image(directory / "file.pfm").image.values == read_image(directory / "pipe.pfm").image.values);
}
