// What the header of a Radiance picture says of its pixels.
#include "image_checks.hpp"

using namespace postfx;
using namespace postfx::testing;

namespace {

const std::string red_then_green("\x80\0\0\x81\0\x80\0\x81", 8);
const std::string white("\x80\x80\x80\x81", 4);

ImageFile read_hdr(const std::string& lines, const std::string& resolution, const std::string& pixels,
                   const ImageRequest& request = {}) {
    return read_image(ImageSource{"a.hdr", "#?RADIANCE\n" + lines + "\n" + resolution + "\n" + pixels},
                      request);
}

ImageFile white_with(const std::string& lines, const ImageRequest& request = {}) {
    return read_hdr(lines, "-Y 1 +X 1", white, request);
}

} // namespace

TEST_CASE("HDR: pixels are divided by every exposure and correction") {
    const ImageFile file = white_with("EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR=1 2 0.5\n");
    CHECK(file.image.values == std::vector<float>{1 / 8.0f, 1 / 16.0f, 1 / 4.0f});
    CHECK(file.honoured.size() == 2);
    CHECK(white_with("EXPOSURE=2\n", {.role = Role::data}).image.values == std::vector<float>{1, 1, 1});
    const ImageFile senseless = white_with("EXPOSURE=0\nCOLORCORR=1 x\n");
    CHECK(senseless.image.values == std::vector<float>{1, 1, 1});
    CHECK(senseless.warnings.size() == 2);
}

TEST_CASE("HDR: colour spaces become Rec. 709") {
    // XYZ of equal energy: the sums of the rows of the standard matrix from XYZ to sRGB.
    const ImageFile xyz = white_with("FORMAT=32-bit_rle_xyze\n");
    const std::vector<double> expected = {1.2048, 0.9484, 0.9089};
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(xyz.image.values[i] == Approx(expected[i]).margin(1e-3));
    const ImageFile adapted = white_with("FORMAT=32-bit_rle_xyze\n", {.adaptation = Adaptation::bradford});
    for (const float value : adapted.image.values)
        CHECK(value == Approx(1));
    const ImageFile p3 = read_hdr("PRIMARIES=.680 .320 .265 .690 .150 .060 .3127 .3290\n", "-Y 1 +X 1",
                                  red_then_green.substr(0, 4));
    CHECK(p3.image.values[0] == Approx(1.22494).margin(1e-4));
    CHECK(p3.image.values[1] == Approx(-0.04206).margin(1e-4));
    CHECK(white_with("PRIMARIES=0 0 0 0 0 0 0 0\n").warnings.size() == 1);
    const ImageFile own = white_with("PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .3290\n");
    CHECK(own.honoured.empty());
    CHECK(own.image.values == std::vector<float>{1, 1, 1});
}

TEST_CASE("HDR: the shape of a pixel") {
    const ImageFile file = white_with("PIXASPECT=2\nPIXASPECT=2\n"); // height over width
    REQUIRE(file.shot.pixel_aspect_ratio);
    CHECK(*file.shot.pixel_aspect_ratio == 0.25);
}

TEST_CASE("HDR: all eight ways in which scanlines may run") {
    // Two pixels, red first, each line by the standard's reading: "-Y" from the top, "+X" from the left.
    const std::vector<std::pair<std::string, std::string>> rows = {
        {"-Y 1 +X 2", "rg"}, {"+Y 1 +X 2", "rg"}, {"-Y 1 -X 2", "gr"}, {"+Y 1 -X 2", "gr"},
        {"+X 2 -Y 1", "rg"}, {"+X 2 +Y 1", "rg"}, {"-X 2 -Y 1", "gr"}, {"-X 2 +Y 1", "gr"}};
    for (const auto& [resolution, expected] : rows) {
        CAPTURE(resolution);
        const Image image = read_hdr("", resolution, red_then_green).image;
        REQUIRE((image.width == 2 && image.height == 1));
        CHECK(image.at(0, 0, 0) == (expected == "rg" ? 1 : 0));
        CHECK(image.at(1, 0, 0) == (expected == "rg" ? 0 : 1));
    }
    const std::vector<std::pair<std::string, int>> columns = {// where red is, counted from the bottom
                                                              {"-Y 2 +X 1", 1},
                                                              {"+Y 2 +X 1", 0},
                                                              {"+X 1 -Y 2", 1},
                                                              {"-X 1 +Y 2", 0}};
    for (const auto& [resolution, row] : columns) {
        CAPTURE(resolution);
        const Image image = read_hdr("", resolution, red_then_green).image;
        REQUIRE((image.width == 1 && image.height == 2));
        CHECK(image.at(0, row, 0) == 1);
    }
}
