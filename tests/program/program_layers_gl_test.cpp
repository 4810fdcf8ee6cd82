// postfx apply on EXR files of several layers and views.
#include "program.hpp"

#include <exr_files.hpp>

#include <image/files.hpp>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// `postfx apply`, without the report.
Outcome apply(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"apply", "-q", "--no-times"});
    return run_program(arguments);
}

std::vector<std::string> view_layer(const std::string& name) {
    return {name + ".Combined.R", name + ".Combined.G", name + ".Combined.B", name + ".Depth.Z"};
}

float first_value(const std::filesystem::path& file) {
    const Image image = read_image(file).image;
    return image.at(0, image.height - 1, 0);
}

} // namespace

TEST_CASE("Two pictures of the same standing are refused until one is chosen") {
    const TemporaryDirectory directory;
    const std::string file = directory / "a.exr", out = directory / "out.pfm";
    std::vector<std::string> names = view_layer("Back");
    for (const std::string& name : view_layer("Hero"))
        names.push_back(name);
    write_scanlines(file, header_of(box(0, 0, 4, 3), box(0, 0, 4, 3)), names);
    check_refused(apply({"--color", file, "--chain", "none", "-o", out}), "--color-layer");
    check_refused(apply({"--color", file, "--color-layer", "Hero.Combined", "--normal", file, "--chain",
                         "none", "-o", out}),
                  "--normal-layer");
    const Outcome chosen = apply(
        {"--color", file, "--color-layer", "Hero.Combined", "--depth", file, "--chain", "none", "-o", out});
    INFO(chosen.err);
    REQUIRE(chosen.status == 0);
    CHECK(first_value(out) == value_at(4, 0, 0));
}

TEST_CASE("All roles are of the view that is asked for") {
    const TemporaryDirectory directory;
    const std::string file = directory / "a.exr", out = directory / "out.pfm";
    write_parts(file, {{"rgba.left", "left", {"R", "G", "B"}},
                       {"rgba.right", "right", {"R", "G", "B"}},
                       {"depth.left", "left", {"Z"}}});
    REQUIRE(apply({"--color", file, "--depth", file, "--chain", "none", "-o", out}).status == 0);
    CHECK(first_value(out) == value_at(0, 0, 0));
    REQUIRE(apply({"--color", file, "--view", "right", "--chain", "none", "-o", out}).status == 0);
    CHECK(first_value(out) == value_at(3, 0, 0));
    check_refused(apply({"--color", file, "--view", "right", "--depth", file, "--chain", "none", "-o", out}),
                  "no depth in its view \"right\"");
}

TEST_CASE("An EXR goes out with all that was in it, or the picture alone") {
    const TemporaryDirectory directory;
    const std::string file = directory / "a.exr", out = directory / "out.exr";
    Imf::Header header = header_of(box(0, 0, 4, 3), box(0, 0, 4, 3));
    Imf::addOwner(header, "someone");
    write_scanlines(file, header, view_layer("View"));
    const std::vector<std::string> dark = {"--color", file, "--effect", "vignette: {strength: 1}", "-o", out};
    REQUIRE(apply(dark).status == 0);
    const Outcome told = run_program({"inspect", out});
    CHECK_THAT(told.out, Catch::Contains("someone"));
    CHECK_THAT(told.out, Catch::Contains("View.Depth"));
    const Image depth = read_image(out, {.role = Role::depth}).image;
    CHECK(depth.values == read_image(file, {.role = Role::depth}).image.values);
    const Image color = read_image(out).image;

    std::vector<std::string> alone = dark;
    alone.push_back("--only-picture");
    REQUIRE(apply(alone).status == 0);
    CHECK_THAT(run_program({"inspect", out}).out, !Catch::Contains("View.Depth"));
    CHECK(read_image(out).image.values == color.values);
}

TEST_CASE("What is brought into shape is told, and refused when strict") {
    const TemporaryDirectory directory;
    const std::string file = directory / "a.exr", out = directory / "out.pfm";
    Imf::Header header(4, 3, 2.0f);
    write_scanlines(file, header, {"R", "G", "B"});
    const Outcome told = run_program({"apply", "--no-times", "--color", file, "--chain", "none", "-o", out});
    CHECK(told.status == 0);
    CHECK_THAT(told.err, Catch::Contains("pixelAspectRatio 2"));
    check_refused(apply({"--strict", "--color", file, "--chain", "none", "-o", out}), "pixelAspectRatio 2");
}
