// What an EXR file's attributes say of its pixels: followed, or told.
#include "exr_files.hpp"
#include "image_checks.hpp"

#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// One pixel of `rgb`.
void write_pixel(const std::filesystem::path& file, Imf::Header header, std::vector<float> rgb,
                 const std::vector<std::string>& names = {"R", "G", "B"}) {
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < names.size(); ++i) {
        header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
        frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, &rgb[i], header.dataWindow()));
    }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame);
    output.writePixels(1);
}

Imf::Header header_with(const Imf::Chromaticities& space) {
    Imf::Header header(1, 1);
    Imf::addChromaticities(header, space);
    return header;
}

bool tells(const std::vector<std::string>& lines, const std::string& word) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(word) != std::string::npos; });
}

using V2f = Imath::V2f;

const Imf::Chromaticities xyz(V2f(1, 0), V2f(0, 1), V2f(0, 0), V2f(1 / 3.0f, 1 / 3.0f));
const Imf::Chromaticities aces(V2f(0.7347f, 0.2653f), V2f(0, 1), V2f(0.0001f, -0.077f),
                               V2f(0.32168f, 0.33767f));

void check_pixel(const Image& image, const std::vector<float>& expected, double margin) {
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(image.values.at(i) == Approx(expected[i]).margin(margin));
}

} // namespace

TEST_CASE("Chromaticities become Rec. 709, for light only") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    write_pixel(file, header_with(xyz), {0.4124f, 0.2126f, 0.0193f, 0.5f}, {"R", "G", "B", "A"});
    for (const Role role : {Role::color, Role::emission, Role::ambient}) {
        const ImageFile read = read_image(file, {.role = role});
        check_pixel(read.image, {1, 0, 0, 0.5f}, 3e-4); // the pixel has four digits
        CHECK(tells(read.honoured, "chromaticities"));
        CHECK(read.warnings.empty());
    }
    for (const Role role : {Role::normal, Role::data, Role::texture}) {
        const ImageFile read = read_image(file, {.role = role});
        CHECK(read.image.values[0] == 0.4124f);
        CHECK(read.honoured.empty());
    }
}

TEST_CASE("White keeps its light unless it is to be adapted") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    write_pixel(file, header_with(aces), {1, 1, 1});
    CHECK(read_image(file).image.values[2] < 0.98f);
    check_pixel(read_image(file, {.adaptation = Adaptation::bradford}).image, {1, 1, 1},
                1e-5); // numbers of float32
    CHECK(tells(read_image(file, {.adaptation = Adaptation::bradford}).honoured, "bradford"));
}

TEST_CASE("Rec. 709 itself keeps its bits") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    write_pixel(file, header_with({}), {0.1f, 0.2f, 0.3f});
    const ImageFile read = read_image(file);
    CHECK(read.image.values == std::vector<float>{0.1f, 0.2f, 0.3f});
    CHECK(read.honoured.empty());
}

TEST_CASE("Chromaticities that make no sense are told") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto space = GENERATE_COPY(
        Imf::Chromaticities(V2f(0, 0), V2f(0, 0), V2f(0, 0), V2f(0, 0)),
        Imf::Chromaticities(V2f(nan, 0.3f), V2f(0.3f, 0.6f), V2f(0.15f, 0.06f), V2f(0.3f, 0.3f)),
        Imf::Chromaticities(V2f(0.1f, 0.1f), V2f(0.2f, 0.2f), V2f(0.3f, 0.3f), V2f(0.2f, 0.2f)));
    write_pixel(file, header_with(space), {0.1f, 0.2f, 0.3f});
    const ImageFile read = read_image(file);
    CHECK(read.image.values == std::vector<float>{0.1f, 0.2f, 0.3f});
    CHECK(tells(read.warnings, "no colour space"));
}

TEST_CASE("Colour spaces by name") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    Imf::Header header(1, 1);
    header.insert("acesImageContainerFlag", Imf::IntAttribute(1));
    write_pixel(file, header, {1, 0, 0});
    const Image by_flag = read_image(file).image;
    write_pixel(file, header_with(aces), {1, 0, 0});
    check_pixel(read_image(file).image, by_flag.values, 1e-6); // rounding of float32 chromaticities

    Imf::Header named(1, 1);
    named.insert("colorInteropID", Imf::StringAttribute("lin_ap0_scene"));
    write_pixel(file, named, {1, 0, 0});
    CHECK(same_values(read_image(file).image, by_flag));
    Imf::Header unknown(1, 1);
    unknown.insert("colorInteropID", Imf::StringAttribute("srgb_rec709_display"));
    write_pixel(file, unknown, {1, 0, 0});
    CHECK(tells(read_image(file).warnings, "srgb_rec709_display"));
}

TEST_CASE("Luminance of white and shape of pixels are told") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    Imf::Header header(1, 1, 2.0f);
    Imf::addWhiteLuminance(header, 100);
    write_pixel(file, header, {1, 2, 3});
    const ImageFile read = read_image(file);
    CHECK(read.image.values == std::vector<float>{1, 2, 3});
    CHECK(read.shot.white_luminance == 100.0);
    CHECK(read.shot.pixel_aspect_ratio == 2.0);
    CHECK(tells(read.honoured, "whiteLuminance 100"));
    CHECK(tells(read.warnings, "pixelAspectRatio 2"));
}

TEST_CASE("worldToCamera: row vectors and a left-handed camera become column vectors and ours") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    // A camera at (10, 20, 30) that looks along the world's +x, with z up: OpenEXR's x is right, y up, z ahead.
    // World (x, y, z) is seen at right = -(y - 20), up = z - 30, ahead = x - 10.
    const Imath::M44f matrix(0, 0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 20, -30, -10, 1);
    Imath::V3f seen;
    matrix.multVecMatrix(Imath::V3f(15, 18, 31), seen);
    REQUIRE(seen == Imath::V3f(2, 1, 5));
    Imf::Header header(1, 1);
    Imf::addWorldToCamera(header, matrix);
    write_pixel(file, header, {1, 2, 3});
    const auto camera = read_image(file).shot.world_to_camera;
    REQUIRE(camera);
    const double point[4] = {15, 18, 31, 1}, expected[4] = {2, 1, -5, 1};
    for (std::size_t row = 0; row < 4; ++row) {
        double value = 0;
        for (std::size_t column = 0; column < 4; ++column)
            value += camera->at(4 * column + row) * point[column];
        CHECK(value == expected[row]);
    }
}

TEST_CASE("Whose axes normals have") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    const auto space_of = [&](const char* mark, const std::string& layer) {
        Imf::Header header(1, 1);
        if (*mark) header.insert(mark, Imf::StringAttribute("1"));
        write_pixel(file, header, {0, 0, 1}, {layer + ".X", layer + ".Y", layer + ".Z"});
        return read_image(file, {.role = Role::normal}).normal_space;
    };
    CHECK(space_of("arnold/version", "N") == NormalSpace::world);
    CHECK(space_of("", "N") == std::nullopt);
    CHECK(space_of("", "ViewLayer.Normal") == NormalSpace::world);
    CHECK(space_of("vrayInfo/vrayversion", "normals") == NormalSpace::view);
    CHECK(space_of("", "WorldNormal") == NormalSpace::world);
    CHECK(space_of("", "cameraNormal") == NormalSpace::view);
}

TEST_CASE("A description tells parts, layers, attributes and roles") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    Imf::Header header = header_with(xyz);
    Imf::addOwner(header, "someone");
    Imf::addFramesPerSecond(header, Imf::Rational(24000, 1001));
    write_pixel(file, header, {1, 2, 3, 4}, {"R", "G", "B", "Z"});
    const ImageDescription description = describe_image(open_image(file));
    CHECK(description.kind == "OpenEXR");
    REQUIRE(description.parts.size() == 1);
    const auto value_of = [&](const std::string& name) -> std::string {
        for (const auto& [attribute, value] : description.parts[0].attributes)
            if (attribute == name) return value;
        return "missing";
    };
    CHECK(value_of("owner") == "someone");
    CHECK(value_of("framesPerSecond") == "24000/1001");
    CHECK(value_of("dataWindow") == "0 0 to 0 0");
    CHECK(value_of("compression") == "ZIP");
    CHECK(value_of("chromaticities").find("white 0.3333333 0.3333333") != std::string::npos);
    REQUIRE(description.layers.size() == 2);
    REQUIRE(description.roles.size() == 5);
    CHECK(description.roles[0].layer == "R,G,B");
    CHECK(description.roles[1].layer == "Z");
    CHECK(description.roles[3].refusal.find("no emission") != std::string::npos);
    CHECK(tells(description.honoured, "chromaticities"));
}
