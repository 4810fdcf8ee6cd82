// A picture written back into the EXR that it came from: everything else stays, bit for bit.
#include "exr_files.hpp"
#include "image_checks.hpp"

#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPreviewImage.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>
#include <cstdint>
#include <map>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// A file whose channels have the types that are told, numbers that differ everywhere, and a tail of bits that float and
/// back would lose if a half became a float of another value.
void write_typed(const std::filesystem::path& file, Imf::Header header,
                 const std::map<std::string, Imf::PixelType>& channels) {
    const Box& data = header.dataWindow();
    const auto width = static_cast<std::size_t>(data.max.x - data.min.x + 1);
    const auto height = static_cast<std::size_t>(data.max.y - data.min.y + 1);
    std::vector<std::vector<std::uint16_t>> memory;
    Imf::FrameBuffer frame;
    std::uint32_t seed = 1;
    for (const auto& [name, type] : channels) {
        header.channels().insert(name, Imf::Channel(type));
        const std::size_t words = type == Imf::HALF ? 1 : 2;
        memory.emplace_back(words * width * height);
        // Positive numbers of every size, finite: the uppermost word stays below the exponent of infinity.
        for (std::uint16_t& word : memory.back())
            word = static_cast<std::uint16_t>((seed = seed * 1664525u + 1013904223u) >> 17) & 0x3fff;
        frame.insert(name, Imf::Slice::Make(type, memory.back().data(), data));
    }
    if (header.hasTileDescription()) {
        Imf::TiledOutputFile output(file.c_str(), header);
        output.setFrameBuffer(frame);
        output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
        return;
    }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame);
    output.writePixels(static_cast<int>(height));
}

/// The numbers of a channel over its part's data window, as bytes.
std::string raw(const std::filesystem::path& file, int part, const std::string& channel) {
    Imf::MultiPartInputFile input(file.c_str());
    Imf::InputPart in(input, part);
    const Imf::Channel* found = in.header().channels().findChannel(channel);
    REQUIRE(found);
    const Box& data = in.header().dataWindow();
    std::string bytes(static_cast<std::size_t>(data.max.x - data.min.x + 1) * (data.max.y - data.min.y + 1)
                          * (found->type == Imf::HALF ? 2 : 4),
                      '\0');
    Imf::FrameBuffer frame;
    frame.insert(channel, Imf::Slice::Make(found->type, bytes.data(), data));
    in.setFrameBuffer(frame);
    in.readPixels(data.min.y, data.max.y);
    return bytes;
}

Imf::Header header_in(const std::filesystem::path& file, int part = 0) {
    Imf::MultiPartInputFile input(file.c_str());
    return input.header(part);
}

const std::map<std::string, Imf::PixelType> layers = {
    {"View.Combined.R", Imf::HALF}, {"View.Combined.G", Imf::HALF}, {"View.Combined.B", Imf::HALF},
    {"View.Combined.A", Imf::HALF}, {"View.Depth.Z", Imf::FLOAT},   {"View.IndexOB.X", Imf::UINT}};

const std::vector<std::string> untouched = {"View.Combined.A", "View.Depth.Z", "View.IndexOB.X"};

/// Read, let `change` do something, write beside; the source's name stays in `read.layer` and so on.
std::vector<std::string> rewrite(const std::filesystem::path& from, const std::filesystem::path& to,
                                 const std::function<void(Image&)>& change,
                                 const ImageRequest& request = {}) {
    const ImageSource source = open_image(from);
    Image image = read_image(source, request).image;
    change(image);
    const Origin origin{&source, request};
    return write_image(to, image, {.origin = &origin});
}

void nothing(Image&) {}

} // namespace

TEST_CASE("A picture that has not changed: the file that it came from") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    const auto compression = GENERATE(Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
                                      Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION);
    const bool tiled = GENERATE(false, true);
    Imf::Header header = header_of(box(0, 0, 40, 30), box(-5, 7, 37, 29));
    header.compression() = compression;
    header.insert("mine", Imf::StringAttribute("kept"));
    if (tiled) header.setTileDescription(Imf::TileDescription(16, 8));
    write_typed(from, header, layers);
    CHECK(rewrite(from, to, nothing).empty());
    for (const auto& [name, type] : layers)
        CHECK(raw(from, 0, name) == raw(to, 0, name));
    CHECK(header_in(to).compression() == compression);
    CHECK(header_in(to).hasTileDescription() == tiled);
    CHECK(header_in(to).dataWindow() == header.dataWindow());
    CHECK(header_in(to).typedAttribute<Imf::StringAttribute>("mine").value() == "kept");
}

TEST_CASE("One pixel changes: nothing else does") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    const auto order = GENERATE(Imf::INCREASING_Y, Imf::DECREASING_Y);
    const bool tiled = GENERATE(false, true);
    const Box display = box(0, 0, 40, 600), data = box(-5, 7, 37, 592);
    Imf::Header header = header_of(display, data);
    header.lineOrder() = order;
    if (tiled) header.setTileDescription(Imf::TileDescription(16, 8));
    write_typed(from, header, layers);
    CHECK(rewrite(from, to, [](Image& image) { image.at(10, 300, 1) = 0.5f; }).empty());
    for (const char* name : {"View.Combined.R", "View.Combined.B"})
        CHECK(raw(from, 0, name) == raw(to, 0, name));
    for (const std::string& name : untouched)
        CHECK(raw(from, 0, name) == raw(to, 0, name));
    std::string green = raw(from, 0, "View.Combined.G");
    // Row 300 from the bottom of 600 is row 299 from the top, 292 of the data.
    const std::size_t at = 2 * ((299 - 7) * 37 + 10 + 5);
    green.replace(at, 2, std::string("\x00\x38", 2)); // 0.5 as half
    CHECK(raw(to, 0, "View.Combined.G") == green);
    CHECK(header_in(to).lineOrder() == order);
    const auto type = header_in(to).channels().findChannel("View.IndexOB.X")->type;
    CHECK(type == Imf::UINT);
}

TEST_CASE("Compressions that lose bits give way where something else is in the part") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    Imf::Header header = header_of(box(0, 0, 40, 30), box(0, 0, 40, 30));
    header.compression() =
        GENERATE(Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION);
    write_typed(from, header, layers);
    const auto remarks = rewrite(from, to, [](Image& image) { image.at(10, 3, 1) = 0.5f; });
    REQUIRE(remarks.size() == 1);
    CHECK(remarks[0].find("ZIP") != std::string::npos);
    for (const std::string& name : untouched)
        CHECK(raw(from, 0, name) == raw(to, 0, name));
    CHECK(raw(from, 0, "View.Combined.R") == raw(to, 0, "View.Combined.R"));
}

TEST_CASE("Light beside the data makes its window larger") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    const bool tiled = GENERATE(false, true);
    Imf::Header header = header_of(box(0, 0, 40, 30), box(10, 10, 5, 5));
    if (tiled) header.setTileDescription(Imf::TileDescription(4, 4));
    write_typed(from, header, layers);
    const auto remarks = rewrite(from, to, [](Image& image) { image.at(20, 2, 0) = 0.25f; });
    REQUIRE(remarks.size() == 1);
    CHECK(remarks[0].find("10 10 to 20 27") != std::string::npos);
    CHECK(header_in(to).dataWindow() == box(10, 10, 11, 18));
    const Image image = read_image(to).image;
    CHECK(image.at(20, 2, 0) == 0.25f);
    for (const Role role : {Role::depth, Role::color}) {
        Image before = read_image(from, {.role = role}).image, after = read_image(to, {.role = role}).image;
        if (role == Role::color) after.at(20, 2, 0) = 0;
        CHECK(same_values(before, after));
    }
}

TEST_CASE("Parts and views that are not the picture's stay") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    write_parts(from,
                {{"rgba.left", "left", {"R", "G", "B"}},
                 {"rgba.right", "right", {"R", "G", "B"}},
                 {"depth.left", "left", {"Z"}}},
                box(0, 0, 5, 4));
    const auto add = [](Image& image) { image.at(1, 1, 2) += 1; };
    CHECK(rewrite(from, to, add, {.view = "right"}).empty());
    CHECK(header_in(to, 1).view() == "right");
    CHECK(raw(from, 0, "B") == raw(to, 0, "B"));
    CHECK(raw(from, 2, "Z") == raw(to, 2, "Z"));
    CHECK(raw(from, 1, "G") == raw(to, 1, "G"));
    CHECK(raw(from, 1, "B") != raw(to, 1, "B"));
    Image expected = read_image(from, {.view = "right"}).image;
    add(expected);
    CHECK(same_values(read_image(to, {.view = "right"}).image, expected));
}

TEST_CASE("Deep parts are carried as they are packed") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    write_deep_part(from);
    CHECK(rewrite(from, to, [](Image& image) { image.at(1, 1, 2) += 1; }).empty());
    CHECK(header_in(to, 1).type() == Imf::DEEPSCANLINE);
    // What the part's rows are packed into is at the end of both files; their heads have the same length.
    const std::string before = file_bytes(from), after = file_bytes(to);
    const std::size_t deep_bytes =
        2 * (4 + 4 + 3 * 8 + 2); // per row: part, y, three sizes, at least a byte each
    CHECK(before.substr(before.size() - deep_bytes) == after.substr(after.size() - deep_bytes));
}

TEST_CASE("A part whose pixels were never written is left out, and told") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    std::vector<Imf::Header> headers(2, header_of(box(0, 0, 2, 2), box(0, 0, 2, 2)));
    headers[0].setName("rgba");
    headers[1].setName("depth");
    const Planes color(headers[0], {"R", "G", "B"}), depth(headers[1], {"Z"});
    for (Imf::Header& header : headers)
        header.setType(Imf::SCANLINEIMAGE);
    {
        Imf::MultiPartOutputFile output(from.c_str(), headers.data(), 2);
        Imf::OutputPart part(output, 0);
        part.setFrameBuffer(color.frame);
        part.writePixels(2);
    }
    const auto remarks = rewrite(from, to, nothing);
    REQUIRE(remarks.size() == 1);
    CHECK(remarks[0] == "part 2 is truncated and was left out");
    CHECK(same_values(read_image(from).image, read_image(to).image));
}

TEST_CASE("The file's colour space stays, and what is written is right in it") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    Imf::Header header = header_of(box(0, 0, 3, 2), box(0, 0, 3, 2));
    Imf::addChromaticities(header, {Imath::V2f(0.713f, 0.293f), Imath::V2f(0.165f, 0.83f),
                                    Imath::V2f(0.128f, 0.044f), Imath::V2f(0.32168f, 0.33767f)});
    const auto adaptation = GENERATE(Adaptation::none, Adaptation::bradford);
    write_scanlines(from, header, {"R", "G", "B"});
    const ImageRequest request = {.adaptation = adaptation};
    Image wanted;
    rewrite(
        from, to,
        [&](Image& image) {
            for (int channel = 0; channel < 3; ++channel)
                image.at(1, 1, channel) = 0.25f * static_cast<float>(channel + 1);
            wanted = image;
        },
        request);
    const Image read = read_image(to, request).image;
    for (std::size_t i = 0; i < wanted.values.size(); ++i)
        CHECK(read.values[i] == Approx(wanted.values[i]).epsilon(1e-5)); // there and back in float32
    // Pixels that have not changed have their bits.
    const std::string before = raw(from, 0, "R"), after = raw(to, 0, "R");
    CHECK(before.substr(0, 4) == after.substr(0, 4));
    CHECK(before.substr(8) == after.substr(8));
    CHECK(before.substr(4, 4) != after.substr(4, 4));
}

TEST_CASE("Grey stays grey, or gets the channels that colour needs") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    write_scanlines(from, header_of(box(0, 0, 3, 2), box(0, 0, 3, 2)), {"Y", "Z"});
    const ImageSource source = open_image(from);
    Image image(3, 2, 3);
    const Image grey = read_image(source).image;
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = grey.values[i / 3];
    for (int channel = 0; channel < 3; ++channel)
        image.at(1, 1, channel) = 5;
    const Origin origin{&source, {}};
    CHECK(write_image(to, image, {.origin = &origin}).empty());
    CHECK(read_image(to).image.channels == 1);
    CHECK(read_image(to).image.at(1, 1, 0) == 5);
    image.at(1, 1, 2) = 6;
    CHECK(write_image(to, image, {.origin = &origin}).size() == 1);
    CHECK(same_values(read_image(to).image, image));
    CHECK(raw(from, 0, "Z") == raw(to, 0, "Z"));
}

TEST_CASE("What becomes of a preview and of large numbers is told") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    Imf::Header header = header_of(box(0, 0, 3, 2), box(0, 0, 3, 2));
    header.setPreviewImage(Imf::PreviewImage(1, 1));
    write_typed(from, header, layers);
    CHECK(rewrite(from, to, nothing).empty());
    CHECK(header_in(to).hasPreviewImage());
    const auto remarks = rewrite(from, to, [](Image& image) { image.at(1, 1, 0) = 1e6f; });
    CHECK(remarks.size() == 2); // the preview; a half that is infinite now
    CHECK_FALSE(header_in(to).hasPreviewImage());
}

TEST_CASE("Smaller levels of a changed picture are left out, and told") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.exr", to = directory / "b.exr";
    Imf::Header header = header_of(box(0, 0, 40, 30), box(0, 0, 40, 30));
    header.setTileDescription(Imf::TileDescription(16, 8, Imf::MIPMAP_LEVELS));
    const Planes planes(header, {"R", "G", "B", "Z"});
    {
        Imf::TiledOutputFile output(from.c_str(), header);
        output.setFrameBuffer(planes.frame);
        for (int level = 0; level < output.numLevels(); ++level)
            output.writeTiles(0, output.numXTiles(level) - 1, 0, output.numYTiles(level) - 1, level);
    }
    CHECK(rewrite(from, to, nothing).empty());
    CHECK(header_in(to).tileDescription().mode == Imf::MIPMAP_LEVELS);
    CHECK(rewrite(from, to, [](Image& image) { image.at(1, 1, 0) = 7; }).size() == 1);
    CHECK(header_in(to).tileDescription().mode == Imf::ONE_LEVEL);
    CHECK(raw(from, 0, "Z") == raw(to, 0, "Z"));
}

TEST_CASE("Other kinds of files carry nothing") {
    const TemporaryDirectory directory;
    const auto from = directory / "a.pfm", to = directory / "b.exr";
    write_image(from, Image(2, 2, 3, 0.5f));
    const ImageSource source = open_image(from);
    const Origin origin{&source, {}};
    CHECK(write_image(to, Image(2, 2, 3, 0.25f), {.origin = &origin}).empty());
    CHECK(read_image(to).image.at(0, 0, 0) == 0.25f);
}

TEST_CASE("The other eye of the beach ball stays") {
    const auto from = test_data("beachball.0001.exr");
    if (from.empty()) return;
    const TemporaryDirectory directory;
    const auto to = directory / "b.exr";
    CHECK(rewrite(from, to, [](Image& image) { image.at(1000, 800, 0) = 0.5f; }).empty());
    const Imf::Header header = header_in(from);
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        CAPTURE(i.name());
        const bool same = raw(from, 0, i.name()) == raw(to, 0, i.name());
        CHECK(same == (std::string(i.name()) != "R"));
    }
}
