// JPEG: what its segments say of its pixels.
#include "icc_profiles.hpp"
#include "image_checks.hpp"

#include <jpeg_segments.hpp>

#include <image/srgb.hpp>

#include <cstdio> // before jpeglib.h, which needs it

#include <jpeglib.h>

#include <cmath>
#include <functional>

using namespace postfx;
using namespace postfx::testing;

namespace {

using SetUp = std::function<void(jpeg_compress_struct&)>;

/// 16 x 8 pixels of one colour, of as many components as `codes` has, by libjpeg; `set_up` before it begins.
std::string jpeg_of(const std::vector<std::uint8_t>& codes, J_COLOR_SPACE space, const SetUp& set_up) {
    jpeg_error_mgr errors;
    jpeg_compress_struct info{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &bytes, &size);
    info.image_width = 16;
    info.image_height = 8;
    info.input_components = static_cast<int>(codes.size());
    info.in_color_space = space;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 100, TRUE);
    if (set_up) set_up(info);
    jpeg_start_compress(&info, TRUE);
    std::vector<std::uint8_t> row;
    for (int x = 0; x < 16; ++x)
        row.insert(row.end(), codes.begin(), codes.end());
    for (int y = 0; y < 8; ++y) {
        JSAMPROW pointer = row.data();
        jpeg_write_scanlines(&info, &pointer, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    std::string result(reinterpret_cast<char*>(bytes), size);
    std::free(bytes);
    return result;
}

/// In pieces of 200 bytes, the last one first.
std::string profile_segments(const std::string& profile) {
    const std::size_t size = 200, count = (profile.size() + size - 1) / size;
    std::string segments;
    for (std::size_t i = count; i-- > 0;)
        segments += segment(0xe2, std::string("ICC_PROFILE\0", 12) + static_cast<char>(i + 1)
                                      + static_cast<char>(count) + profile.substr(i * size, size));
    return segments;
}

ImageFile read_jpeg(const std::string& bytes, Role role = Role::color) {
    return read_image(ImageSource{"a.jpg", bytes}, {.role = role});
}

std::string red() {
    return jpeg_of({200, 60, 30}, JCS_RGB, {});
}

/// Quality 100 rounds a colour by a code or two.
void check_codes(const ImageFile& file, const std::vector<int>& codes) {
    REQUIRE(file.image.channels == static_cast<int>(codes.size()));
    for (std::size_t i = 0; i < codes.size(); ++i)
        CHECK(std::fabs(linear_to_srgb(file.image.values[i]) * 255 - codes[i]) <= 2);
}

} // namespace

TEST_CASE("JPEG: grey, YCbCr and RGB, sequential and progressive") {
    check_codes(read_jpeg(jpeg_of({77}, JCS_GRAYSCALE, {})), {77});
    check_codes(read_jpeg(red()), {200, 60, 30});
    check_codes(
        read_jpeg(jpeg_of({200, 60, 30}, JCS_RGB, [](auto& info) { jpeg_set_colorspace(&info, JCS_RGB); })),
        {200, 60, 30});
    check_codes(
        read_jpeg(jpeg_of({200, 60, 30}, JCS_RGB, [](auto& info) { jpeg_simple_progression(&info); })),
        {200, 60, 30});
}

TEST_CASE("JPEG: an ICC profile in pieces") {
    const ImageFile file =
        read_jpeg(with_segments(jpeg_of({255, 0, 0}, JCS_RGB, {}), profile_segments(p3_profile(2.2))));
    CHECK_FALSE(file.coding.plain_srgb);
    CHECK(file.honoured.size() == 1);
    // Linear Display P3 red in Rec. 709; a code off is 1 % of the light.
    CHECK(file.image.values[0] == Approx(1.22494).margin(0.02));
    CHECK(file.image.values[1] == Approx(-0.04206).margin(0.005));
    const ImageFile same =
        read_jpeg(with_segments(red(), profile_segments(bytes_of(cmsCreate_sRGBProfile()))));
    CHECK(same.coding.plain_srgb);
    // A piece is missing.
    std::string pieces = profile_segments(p3_profile(2.2));
    pieces.erase(0, 4 + static_cast<std::size_t>(static_cast<std::uint8_t>(pieces[3])) - 2 + 0);
    const ImageFile damaged = read_jpeg(with_segments(red(), pieces));
    CHECK(damaged.warnings.size() >= 1);
    check_codes(damaged, {200, 60, 30});
    CHECK(read_jpeg(with_segments(red(), profile_segments(p3_profile(2.2))), Role::data).honoured.empty());
}

TEST_CASE("JPEG: CMYK of Adobe is upside down, and a profile says what the inks look like") {
    // 20 % cyan, 10 % black. libjpeg marks CMYK files as Adobe's, whose largest code is no ink.
    const std::vector<std::uint8_t> light = {204, 255, 255, 229};
    for (const J_COLOR_SPACE space : {JCS_CMYK, JCS_YCCK}) {
        const std::string bytes =
            jpeg_of(light, JCS_CMYK, [&](auto& info) { jpeg_set_colorspace(&info, space); });
        const ImageFile plain = read_jpeg(bytes);
        CHECK(plain.warnings.size() == 1);
        check_codes(plain, {183, 229, 229}); // 255 * 0.8 * 0.9, 255 * 0.9
        const ImageFile proper = read_jpeg(with_segments(bytes, profile_segments(ink_profile())));
        CHECK(proper.warnings.empty());
        // Lightness 100 * 0.9 * (1 - 0.2 / 2) = 81: Y = ((81 + 16) / 116)^3
        REQUIRE(proper.image.channels == 3);
        for (int channel = 0; channel < 3; ++channel)
            CHECK(proper.image.values[static_cast<std::size_t>(channel)] == Approx(0.58474).margin(0.01));
    }
    const std::string unmarked =
        jpeg_of({51, 0, 0, 26}, JCS_CMYK, [](auto& info) { info.write_Adobe_marker = FALSE; });
    check_codes(read_jpeg(unmarked), {183, 229, 229});
}

TEST_CASE("JPEG: what EXIF says") {
    const ImageFile file = read_jpeg(with_segments(red(), exif_segment(6, 1)));
    REQUIRE((file.image.width == 8 && file.image.height == 16));
    CHECK(file.shot.orientation == 6);
    REQUIRE(file.shot.focal_length_mm);
    CHECK(*file.shot.focal_length_mm == 4.25);
    REQUIRE(file.shot.focal_length_35mm);
    CHECK(*file.shot.focal_length_35mm == 26);
    CHECK(read_jpeg(with_segments(red(), exif_segment(6, 1)), Role::texture).image.width == 16);
    CHECK(read_jpeg(with_segments(red(), exif_segment(0, 1))).image.width == 16);

    // Adobe RGB by name: its green has more red taken away in Rec. 709 (0.21, 0.71 against 0.30, 0.60).
    const std::string green = jpeg_of({0, 255, 0}, JCS_RGB, {});
    const ImageFile adobe = read_jpeg(with_segments(green, exif_segment(1, 0xffff, "R03")));
    CHECK(adobe.honoured.size() == 1);
    CHECK(adobe.image.values[0] == Approx(-0.3982).margin(0.02));
    const ImageFile unknown = read_jpeg(with_segments(green, exif_segment(1, 0xffff)));
    CHECK(unknown.warnings.size() == 1);
    CHECK(unknown.coding.plain_srgb);

    const std::string exif = exif_segment(6, 1);
    for (std::size_t size = 10; size < exif.size() - 4; ++size)
        CHECK_NOTHROW(read_jpeg(with_segments(red(), segment(0xe1, exif.substr(4, size)))));
    CHECK_FALSE(read_jpeg(with_segments(red(), segment(0xe1, exif.substr(4, 40)))).warnings.empty());
}

TEST_CASE("JPEG: files that would cost more than they are worth") {
    std::string large = red();
    const std::size_t head = large.find("\xff\xc0") + 5;
    large.replace(head, 4, std::string("\x7f\xff\x20\0", 4));
    CHECK_THROWS_WITH(read_jpeg(large), Catch::Contains("can't hold"));
    // The last scan of a progressive picture, again and again.
    std::string bytes = jpeg_of({200, 60, 30}, JCS_RGB, [](auto& info) { jpeg_simple_progression(&info); });
    const std::size_t last = bytes.rfind("\xff\xda");
    const std::string scan = bytes.substr(last, bytes.size() - 2 - last);
    for (int i = 0; i < 1000; ++i)
        bytes.insert(bytes.size() - 2, scan);
    CHECK_THROWS_AS(read_jpeg(bytes), Error);
}

TEST_CASE("JPEG files of ours are sRGB by profile, and the same every time") {
    const TemporaryDirectory directory;
    Image image(16, 8, 4, 0.5f);
    write_image(directory / "a.jpg", image);
    const std::string bytes = file_bytes(directory / "a.jpg");
    CHECK(bytes.find("ICC_PROFILE") != std::string::npos);
    const ImageFile file = read_image(directory / "a.jpg");
    CHECK(file.coding.plain_srgb);
    check_codes(file, {188, 188, 188});
    write_image(directory / "b.jpeg", image);
    CHECK(file_bytes(directory / "b.jpeg") == bytes);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<float>(i * i % 17) / 16;
    write_image(directory / "c.jpg", image);
    write_image(directory / "d.jpg", image, {.quality = 0.3});
    CHECK(file_bytes(directory / "d.jpg").size() < file_bytes(directory / "c.jpg").size());
    CHECK(error_of("e.jpg", [&] { write_image("e.jpg", image, {.quality = 30}); }).find("quality")
          != std::string::npos);
    write_image(directory / "g.jpg", Image(16, 8, 1, 0.5f));
    check_codes(read_image(directory / "g.jpg"), {188});
}

namespace {

std::string base64(const std::string& bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t j = i; j < i + 3; ++j)
            three = three << 8 | (j < bytes.size() ? static_cast<std::uint8_t>(bytes[j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[three >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

std::string xmp_segment(const std::string& xmp) {
    return segment(0xe1, std::string("http://ns.adobe.com/xap/1.0/\0", 29) + xmp);
}

std::string grey_map() {
    return jpeg_of({51}, JCS_GRAYSCALE, {});
}

/// 16 x 8, every sample 0.2.
void check_map(const ImageFile& depth, DepthScale::Kind kind, double at_zero, double at_one) {
    REQUIRE((depth.image.channels == 1 && depth.image.pixel_count() == 16 * 8));
    CHECK(depth.image.values[0] == Approx(0.2).margin(1.1 / 255));
    REQUIRE(depth.depth_scale);
    CHECK(depth.depth_scale->kind == kind);
    CHECK(depth.depth_scale->at_zero == Approx(at_zero));
    CHECK(depth.depth_scale->at_one == Approx(at_one));
}

} // namespace

TEST_CASE("JPEG: the depth that Google's camera writes") {
    for (const std::string format : {"RangeLinear", "RangeInverse"}) {
        const std::string range = "GDepth:Format=\"" + format + "\" GDepth:Near=\"0.5\" GDepth:Far=\"4\" ";
        // The map lies in the extension, in two pieces.
        const std::string data = "GDepth:Data=\"" + base64(grey_map()) + "\"";
        const auto piece = [](const std::string& text) {
            return segment(0xe1, std::string("http://ns.adobe.com/xmp/extension/\0", 35)
                                     + std::string(40, 'x') + text);
        };
        const std::string bytes =
            with_segments(red(), exif_segment(6, 1) + xmp_segment(range) + piece(data.substr(0, 100))
                                     + piece(data.substr(100)));
        const ImageFile depth = read_jpeg(bytes, Role::depth);
        if (format == "RangeLinear")
            check_map(depth, DepthScale::Kind::metres, 0.5, 4);
        else
            check_map(depth, DepthScale::Kind::dioptres, 2, 0.25);
        CHECK(depth.image.width == 8); // turned with the photograph
        check_codes(read_jpeg(bytes), {200, 60, 30});
    }
    CHECK_THROWS_AS(read_jpeg(with_segments(red(), xmp_segment("GDepth:Data=\"???\"")), Role::depth), Error);
}

TEST_CASE("JPEG: Dynamic Depth") {
    const std::string map = grey_map();
    const std::string xmp =
        "DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"1\" DepthMap:Far=\"10\""
        "<Container:Directory><Container:Item Item:Semantic=\"Primary\" Item:Length=\"0\"/>"
        "<Container:Item Item:Semantic=\"Depth\" Item:Length=\""
        + std::to_string(map.size()) + "\"/><Container:Item Item:Semantic=\"Other\" Item:Length=\"4\"/>";
    check_map(read_jpeg(with_segments(red(), xmp_segment(xmp)) + map + "abcd", Role::depth),
              DepthScale::Kind::dioptres, 1, 0.1);
}

TEST_CASE("JPEG: the second picture of a phone's export that says it is disparity") {
    const std::string map =
        with_segments(grey_map(), xmp_segment("<apdi:AuxiliaryImageType>disparity</apdi:AuxiliaryImageType>"
                                              "<apdi:FloatMinValue>0.25</apdi:FloatMinValue>"
                                              "<apdi:FloatMaxValue>4</apdi:FloatMaxValue>"));
    const auto index = [&](std::size_t offset) {
        return segment(0xe2, std::string("MPF\0II*\0", 8) + little(8, 4) + little(1, 2)
                                 + field(0xb002, 7, 32, 26) + little(0, 4) + std::string(16, '\0')
                                 + little(0, 4) + little(static_cast<std::uint32_t>(map.size()), 4)
                                 + little(static_cast<std::uint32_t>(offset), 4) + little(0, 4));
    };
    const std::size_t whole = with_segments(red(), index(0)).size();
    // Offsets count from behind "MPF" and its end, 10 bytes into the file.
    check_map(read_jpeg(with_segments(red(), index(whole - 10)) + map, Role::depth),
              DepthScale::Kind::dioptres, 0.25, 4);
    // Nonsense leaves the photograph as the map.
    CHECK(read_jpeg(with_segments(red(), index(0xffffffff)) + map, Role::depth).image.channels == 3);
}
