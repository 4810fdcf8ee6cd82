// EXR files, written here with the library itself where write_image has no such thing.
#include "exr_files.hpp"
#include "image_checks.hpp"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfMultiView.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// The image is the display window, with value_at where it is in the data window and 0 elsewhere.
void check_values(const Image& image, const Box& display, const Box& data, std::size_t first_channel = 0) {
    REQUIRE(image.width == display.max.x - display.min.x + 1);
    REQUIRE(image.height == display.max.y - display.min.y + 1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int channel = 0; channel < image.channels; ++channel) {
                const int file_x = display.min.x + x, file_y = display.max.y - y;
                const bool there = data.intersects(Imath::V2i(file_x, file_y));
                const auto index = first_channel + static_cast<std::size_t>(channel);
                REQUIRE(image.at(x, y, channel) == (there ? value_at(index, file_x, file_y) : 0.0f));
            }
}

Image peculiar_image(int channels) {
    Image image(6, 3, channels);
    const std::vector<float> peculiar = {std::bit_cast<float>(0x7fc12345u),
                                         std::bit_cast<float>(0xffa00001u),
                                         std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity(),
                                         -0.0f,
                                         std::numeric_limits<float>::denorm_min(),
                                         65504.0f,
                                         0.1f,
                                         3e38f};
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = peculiar[i % peculiar.size()];
    return image;
}

Image layer_of(const std::filesystem::path& file, const std::string& name) {
    return read_image(file, {.role = Role::data, .layer = name}).image;
}

} // namespace

TEST_CASE("Floats come back bit for bit") {
    const TemporaryDirectory directory;
    for (const int channels : {1, 2, 3, 4}) {
        const Image image = peculiar_image(channels);
        write_image(directory / "a.exr", image);
        const ImageFile read = read_image(directory / "a.exr");
        CHECK(same_values(read.image, image));
        CHECK(read.coding.bits != 8);
        CHECK(same_values(read_image(directory / "a.exr", {.role = Role::data}).image, image));
    }
}

TEST_CASE("Half floats come back rounded to 11 bits") {
    const TemporaryDirectory directory;
    Image image(4, 2, 1);
    image.values = {0.1f, -0.0f, 65504.0f, 1e6f, std::nanf(""), -std::numeric_limits<float>::infinity(),
                    1.0f, 6e-8f};
    write_image(directory / "a.exr", image, {.half = true});
    const Image read = read_image(directory / "a.exr").image;
    CHECK(read.values[0] == Approx(0.1f).epsilon(1 / 2048.0)); // half a step of 11 bits
    CHECK(std::signbit(read.values[1]));
    CHECK(read.values[2] == 65504.0f);
    CHECK(read.values[3] == std::numeric_limits<float>::infinity());
    CHECK(std::isnan(read.values[4]));
    CHECK(read.values[5] == -std::numeric_limits<float>::infinity());
    CHECK(read.values[6] == 1.0f);
    CHECK(read.values[7] == std::ldexp(1.0f, -24)); // the smallest half
    write_image(directory / "b.exr", read, {.half = true});
    CHECK(same_values(read_image(directory / "b.exr").image, read));
}

TEST_CASE("The data window may lie anywhere") {
    const TemporaryDirectory directory;
    const Box display = box(0, 0, 9, 7);
    const Box data = GENERATE(box(0, 0, 9, 7), box(2, 1, 3, 4), box(-3, -2, 20, 15), box(5, 4, 10, 10),
                              box(-4, 2, 6, 1), box(100, -100, 2, 3));
    write_scanlines(directory / "a.exr", header_of(display, data), {"R", "G", "B", "A"});
    const Image image = read_image(directory / "a.exr").image;
    REQUIRE(image.channels == 4);
    check_values(image, display, data);
}

TEST_CASE("So may the display window") {
    const TemporaryDirectory directory;
    const Box display = box(-1000000, 500000, 5, 4), data = box(-1000001, 500002, 4, 9);
    write_scanlines(directory / "a.exr", header_of(display, data), {"R", "G", "B"});
    check_values(read_image(directory / "a.exr").image, display, data);
}

TEST_CASE("Tiles, mipmaps, and every compression that loses nothing of 24 bits") {
    const TemporaryDirectory directory;
    const Box display = box(0, 0, 40, 30), data = box(-5, 7, 37, 29);
    const auto levels = GENERATE(Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS);
    const auto compression = GENERATE(Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                      Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION);
    Imf::Header header = header_of(display, data);
    header.compression() = compression;
    header.setTileDescription(Imf::TileDescription(16, 8, levels));
    const Planes planes(header, {"R", "G", "B"});
    {
        Imf::TiledOutputFile output((directory / "tiled.exr").c_str(), header);
        output.setFrameBuffer(planes.frame);
        for (int level = 0; level < output.numLevels(); ++level)
            output.writeTiles(0, output.numXTiles(level) - 1, 0, output.numYTiles(level) - 1, level);
    }
    // The largest value, 20000 + 3500 + 31, is whole and below 2^15: PXR24 keeps 16 bits of it.
    check_values(read_image(directory / "tiled.exr").image, display, data);
    Imf::Header scanline = header_of(display, data);
    scanline.compression() = compression;
    write_scanlines(directory / "lines.exr", scanline, {"R", "G", "B"});
    check_values(read_image(directory / "lines.exr").image, display, data);
}

TEST_CASE("Half and uint channels") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    Imf::Header header(2, 1);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    half grey[2] = {0.5f, -2.0f};
    unsigned id[2] = {7, 4000000000u};
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::HALF, grey, header.dataWindow()));
    frame.insert("id", Imf::Slice::Make(Imf::UINT, id, header.dataWindow()));
    {
        Imf::OutputFile output(file.c_str(), header);
        output.setFrameBuffer(frame);
        output.writePixels(1);
    }
    const ImageFile read = read_image(file);
    CHECK(read.image.values == std::vector<float>{0.5f, -2.0f});
    CHECK(layer_of(file, "id").values == std::vector<float>{7.0f, 4e9f});
}

TEST_CASE("Channels make layers by their prefix") {
    const TemporaryDirectory directory;
    const Box display = box(0, 0, 4, 3);
    const std::filesystem::path file = directory / "a.exr";
    // Indices for value_at:          0    1    2    3      4      5      6      7          8         9 10
    write_scanlines(file, header_of(display, display),
                    {"R", "G", "B", "N.X", "N.Y", "N.Z", "Z", "light.R", "light.G", "light.B", "light.id"});
    const ImageFile read = read_image(file);
    REQUIRE(read.image.channels == 3);
    check_values(read.image, display, display, 0);
    CHECK(layer_of(file, "N").channels == 3);
    check_values(layer_of(file, "N"), display, display, 3);
    check_values(layer_of(file, "Z"), display, display, 6);
    check_values(layer_of(file, "light"), display, display, 7);
    check_values(layer_of(file, "light.id"), display, display, 10);

    check_values(read_image(file, {.role = Role::depth}).image, display, display, 6);
    check_values(read_image(file, {.role = Role::normal}).image, display, display, 3);
    check_values(read_image(file, {.role = Role::data}).image, display, display, 0);
    check_values(read_image(file, {.role = Role::data, .layer = "N"}).image, display, display, 3);
    CHECK(read_image(file, {.role = Role::data, .layer = "N.Z"}).image.channels == 1);
    check_values(read_image(file, {.role = Role::data, .layer = "N.Z"}).image, display, display, 5);
    check_values(read_image(file, {.role = Role::data, .layer = "G"}).image, display, display, 1);
    const std::string message =
        error_of(file, [&] { read_image(file, {.role = Role::data, .layer = "lihgt"}); });
    CHECK(message.find("did you mean \"light\"") != std::string::npos);
    CHECK(message.find("light.id") != std::string::npos);
}

TEST_CASE("The depth of a file") {
    const TemporaryDirectory directory;
    const Box display = box(0, 0, 2, 2);
    const std::filesystem::path file = directory / "a.exr";
    const auto depth_of = [&](const std::vector<std::string>& names) {
        write_scanlines(file, header_of(display, display), names);
        return read_image(file, {.role = Role::depth}).image.at(0, 1, 0)
               / 10000; // the index of the channel that was taken
    };
    CHECK(depth_of({"B", "Z"}) == 1);
    CHECK(depth_of({"R", "G", "B", "depth.Z"}) == 3);
    CHECK(depth_of({"R", "G", "B", "left.Z", "depth"}) == 4); // the left eye is another view
    CHECK(depth_of({"R", "G", "B", "View.Depth.Z"}) == 3);
    CHECK(depth_of({"mask"}) == 0);
    CHECK(depth_of({"Y"}) == 0);
    write_scanlines(file, header_of(display, display), {"B", "G", "R"});
    CHECK(error_of(file, [&] { read_image(file, {.role = Role::depth}); }).find("three different channels")
          != std::string::npos);
    write_scanlines(file, header_of(display, display), {"u", "v"});
    CHECK(error_of(file, [&] { read_image(file, {.role = Role::depth}); }).find("\"u\", \"v\"")
          != std::string::npos);
    CHECK(read_error(file).find("no color") != std::string::npos);
}

TEST_CASE("Luminance and chroma become colour") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    const auto channels = GENERATE(Imf::WRITE_YC, Imf::WRITE_YCA);
    const std::vector<Imf::Rgba> pixels(8 * 6, Imf::Rgba(0.5f, 0.25f, 0.125f, 0.75f));
    {
        Imf::RgbaOutputFile output(file.c_str(), 8, 6, channels);
        output.setFrameBuffer(pixels.data(), 1, 8);
        output.writePixels(6);
    }
    const Image image = read_image(file).image;
    REQUIRE(image.channels == (channels == Imf::WRITE_YCA ? 4 : 3));
    const float expected[4] = {0.5f, 0.25f, 0.125f, 0.75f};
    for (int channel = 0; channel < image.channels; ++channel)
        CHECK(image.at(3, 2, channel)
              == Approx(expected[channel]).epsilon(1 / 64.0)); // chroma is rounded to 5 bits
}

TEST_CASE("A small file asks for little memory") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    write_scanlines(file, header_of(box(0, 0, 16384, 16384), box(0, 0, 1, 1)), {"R", "G", "B"});
    CHECK(read_error(file).find("absurd size") != std::string::npos);
    // What an empty frame of 4K looks like is fine.
    write_scanlines(file, header_of(box(0, 0, 4096, 2160), box(0, 0, 1, 1)), {"R", "G", "B"});
    CHECK(read_image(file).image.width == 4096);
}

TEST_CASE("A deep part is in nobody's way") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    write_deep_part(file);
    const ImageFile read = read_image(file);
    check_values(read.image, box(0, 0, 2, 2), box(0, 0, 2, 2));
    REQUIRE(read.warnings.size() == 1);
    CHECK(read.warnings[0].find("part 2 holds deep data") != std::string::npos);
    CHECK(describe_image(open_image(file)).parts.size() == 2);
}

TEST_CASE("A truncated part is in nobody's way") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    write_parts(file, {{"rgba", "", {"R", "G", "B"}}, {"depth", "", {"Z"}}});
    const std::string bytes = file_bytes(file);
    put_bytes(file, bytes.substr(0, bytes.size() - 1));
    check_values(read_image(file).image, box(0, 0, 2, 2), box(0, 0, 2, 2));
    CHECK(error_of(file, [&] { read_image(file, {.role = Role::depth}); }).find("truncated")
          != std::string::npos);
}

TEST_CASE("Depth that is a grey picture") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    Image grey(2, 1, 4);
    grey.values = {5, 5, 5, 1, 7, 7, 7, 1};
    write_image(file, grey);
    const ImageFile depth = read_image(file, {.role = Role::depth});
    CHECK(depth.image.values == std::vector<float>{5, 7});
    CHECK(depth.warnings.size() == 1);
    grey.values[4] = 8;
    write_image(file, grey);
    CHECK(error_of(file, [&] { read_image(file, {.role = Role::depth}); }).find("no depth")
          != std::string::npos);
}

TEST_CASE("A colour that is not whole is filled with 0") {
    const TemporaryDirectory directory;
    const Box display = box(0, 0, 2, 2);
    write_scanlines(directory / "a.exr", header_of(display, display), {"G", "A"});
    const Image image = read_image(directory / "a.exr").image;
    REQUIRE(image.channels == 4);
    CHECK(image.at(1, 1, 0) == 0);
    CHECK(image.at(1, 1, 1) == value_at(0, 1, 0));
    CHECK(image.at(1, 1, 2) == 0);
    CHECK(image.at(1, 1, 3) == value_at(1, 1, 0));
}

TEST_CASE("Stereo: the unprefixed view, else the default one, else the first") {
    const TemporaryDirectory directory;
    const Box display = box(0, 0, 2, 2);
    const std::filesystem::path file = directory / "a.exr";
    const std::vector<std::string> both = {"left.R", "left.G", "left.B", "right.R", "right.G", "right.B"};
    write_scanlines(file, header_of(display, display), both);
    check_values(read_image(file).image, display, display, 0);
    CHECK(layer_of(file, "right").channels == 3);

    Imf::Header right_first = header_of(display, display);
    Imf::addMultiView(right_first, {"right", "left"});
    write_scanlines(file, right_first, both);
    check_values(read_image(file).image, display, display, 3);

    write_scanlines(file, right_first, {"left.R", "left.G", "left.B", "R", "G", "B"});
    check_values(read_image(file).image, display, display, 3);
}

TEST_CASE("What is refused, and why") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "a.exr";
    SECTION("subsampled channels") {
        Imf::Header header(2, 2);
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
        float values[4] = {};
        Imf::FrameBuffer frame;
        frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, values, header.dataWindow()));
        frame.insert("RY", Imf::Slice::Make(Imf::FLOAT, values, header.dataWindow(), 0, 0, 2, 2));
        {
            Imf::OutputFile output(file.c_str(), header);
            output.setFrameBuffer(frame);
            output.writePixels(2);
        }
        CHECK(error_of(file, [&] { layer_of(file, "RY"); }).find("RY is subsampled") != std::string::npos);
        CHECK(read_image(file).image.channels == 1); // nobody asks for RY
    }
    SECTION("deep data") {
        Imf::Header header(1, 1);
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        unsigned count = 1;
        float sample = 3;
        float* samples = &sample;
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, reinterpret_cast<char*>(&count), sizeof count, sizeof count));
        frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(&samples), sizeof samples,
                                         sizeof samples, sizeof sample));
        {
            Imf::DeepScanLineOutputFile output(file.c_str(), header);
            output.setFrameBuffer(frame);
            output.writePixels(1);
        }
        CHECK(read_error(file).find("deep data") != std::string::npos);
        CHECK(read_error(file).find("flatten it") != std::string::npos);
    }
    SECTION("absurd windows") {
        write_image(file, Image(3, 3, 1));
        const std::string bytes = file_bytes(file);
        const std::string window(std::string("\0\0\0\0\0\0\0\0\2\0\0\0\2\0\0\0", 16)); // 0, 0, 2, 2
        const std::string side = std::string("\0\0\x01\0", 4);                         // 65536
        const std::string huge = std::string("\xff\xff\xff\x3f", 4);                   // 2^30 - 1
        for (const char* name : {"displayWindow", "dataWindow"})
            for (const std::string& corner : {side, huge}) {
                std::string hostile = bytes;
                const std::size_t at = hostile.find(window, hostile.find(name));
                REQUIRE(at != std::string::npos);
                hostile.replace(at + 8, 8, corner + corner);
                put_bytes(file, hostile);
                read_error(file);
            }
    }
    SECTION("any damaged byte: an Error or a picture, nothing else") {
        write_image(file, Image(9, 5, 3, 0.5f));
        const std::string bytes = file_bytes(file);
        int refused = 0;
        for (std::size_t at = 0; at < bytes.size(); ++at)
            for (const char damage : {'\x7f', '\xff'}) {
                std::string damaged = bytes;
                damaged[at] = damage;
                put_bytes(file, damaged);
                try {
                    read_image(file);
                } catch (const Error&) {
                    ++refused;
                }
            }
        CHECK(refused > 0);
    }
}

TEST_CASE("Truncated EXR files are refused") {
    const TemporaryDirectory directory;
    write_image(directory / "a.exr", peculiar_image(4));
    check_truncated(directory, directory / "a.exr", file_bytes(directory / "a.exr").size(), 1);
    const Box display = box(0, 0, 20, 20);
    Imf::Header header = header_of(display, display);
    header.setTileDescription(Imf::TileDescription(8, 8));
    const Planes planes(header, {"R", "G", "B"});
    {
        Imf::TiledOutputFile output((directory / "tiled.exr").c_str(), header);
        output.setFrameBuffer(planes.frame);
        output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
    }
    check_truncated(directory, directory / "tiled.exr", file_bytes(directory / "tiled.exr").size(), 13);
}

TEST_CASE("The beach ball of others") {
    const auto file = test_data("beachball.0001.exr");
    if (file.empty()) return;
    const ImageFile ball = read_image(file);
    REQUIRE((ball.image.width == 2048 && ball.image.height == 1556 && ball.image.channels == 4));
    CHECK(layer_of(file, "left").channels == 4);
    CHECK(layer_of(file, "left.Z").channels == 1);
    CHECK(layer_of(file, "disparityL").channels == 2);
    const Image depth = layer_of(file, "Z");
    CHECK(same_values(read_image(file, {.role = Role::depth}).image, depth));
    CHECK(read_image(file, {.role = Role::depth, .view = "left"}).layer == "Z");
    CHECK(
        same_values(read_image(file, {.role = Role::depth, .view = "left"}).image, layer_of(file, "left.Z")));
    CHECK(same_values(read_image(file, {.view = "left"}).image, layer_of(file, "left")));
    CHECK(ball.view == "right"); // the default one of its multiView attribute
    // Data window of the header: x from 654 to 1564, y from 245 to 1120 from the top. Z = 0 is "nothing
    // there".
    std::size_t hit = 0;
    for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x) {
            const int from_top = depth.height - 1 - y;
            const bool inside = x >= 654 && x <= 1564 && from_top >= 245 && from_top <= 1120;
            const float z = depth.at(x, y, 0);
            REQUIRE((std::isfinite(z) && z >= 0));
            if (z > 0) REQUIRE(inside);
            hit += z > 0;
        }
    CHECK(hit > 100000);
    CHECK(ball.image.at(0, 0, 3) == 0);
    const TemporaryDirectory directory;
    write_image(directory / "ball.exr", ball.image, {.half = true});
    CHECK(same_values(read_image(directory / "ball.exr").image, ball.image)); // the file's channels are half
}
