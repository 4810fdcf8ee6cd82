// What BMP, TGA, PSD, TIFF, EXIF and PNM say of their pixels besides the pixels: each is followed or told.
#include "icc_profiles.hpp"
#include "image_checks.hpp"
#include "png_bytes.hpp"

#include <jpeg_segments.hpp>

#include <image/orientation.hpp>

#include <bit>
#include <cmath>

using namespace postfx;
using namespace postfx::testing;
using namespace std::string_literals;

namespace {

std::string big(unsigned value, int bytes = 4) {
    const std::string text = little(value, bytes);
    return {text.rbegin(), text.rend()};
}

ImageFile color_of(const std::string& bytes) {
    return read_image(ImageSource{"a", bytes}, {.role = Role::color});
}

bool is_told(const ImageFile& file, const std::string& word) {
    for (const std::string& line : file.warnings)
        if (line.find(word) != std::string::npos) return true;
    return false;
}

/// One pixel of 24 bits: blue, green, red. `more`: the header behind the first 40 bytes.
std::string bmp(int height, const std::string& pixels, const std::string& more = "", unsigned across = 1,
                unsigned down = 1) {
    const auto header = static_cast<unsigned>(40 + more.size());
    return "BM" + little(static_cast<unsigned>(14 + header + pixels.size())) + little(0) + little(14 + header)
           + little(header) + little(1) + little(static_cast<unsigned>(height)) + little(1, 2) + little(24, 2)
           + little(0) + little(static_cast<unsigned>(pixels.size())) + little(across) + little(down)
           + little(0) + little(0) + more + pixels;
}

/// The rest of a BITMAPV4HEADER: masks, kind of colours, end points, gammas.
std::string version_4(unsigned kind, double gamma) {
    std::string more(16, '\0');
    more += little(kind) + std::string(36, '\0');
    for (int i = 0; i < 3; ++i)
        more += little(static_cast<unsigned>(std::lround(gamma * 65536)));
    return more;
}

std::string tga(unsigned width, const std::string& pixels, unsigned bits, unsigned descriptor,
                const std::string& extension = "") {
    std::string file = "\0\0\2\0\0\0\0\0\0\0\0\0"s + little(width, 2) + little(1, 2) + static_cast<char>(bits)
                       + static_cast<char>(descriptor) + pixels;
    if (extension.empty()) return file;
    const auto at = static_cast<unsigned>(file.size());
    return file + extension + little(at) + little(0) + "TRUEVISION-XFILE.\0"s;
}

std::string tga_extension(unsigned gamma_tenths, unsigned alpha) {
    return std::string(478, '\0') + little(gamma_tenths, 2) + little(10, 2) + std::string(12, '\0')
           + static_cast<char>(alpha);
}

/// One pixel, each channel with `bits`.
std::string psd(int bits, const std::string& samples, const std::string& resources = "", int packed = 0) {
    return "8BPS" + big(1, 2) + std::string(6, '\0') + big(3, 2) + big(1) + big(2)
           + big(static_cast<unsigned>(bits), 2) + big(3, 2) + big(0)
           + big(static_cast<unsigned>(resources.size())) + resources + big(0)
           + big(static_cast<unsigned>(packed), 2) + samples;
}

std::string psd_resource(unsigned id, const std::string& data) {
    return "8BIM" + big(id, 2) + std::string(2, '\0') + big(static_cast<unsigned>(data.size())) + data
           + std::string(data.size() % 2, '\0');
}

/// Little-endian EXIF with an orientation, and with a gamma in its own directory.
std::string exif(unsigned orientation, unsigned gamma_tenths = 0) {
    const std::string head = "II*\0"s + little(8) + little(2, 2) + little(0x112, 2) + little(3, 2) + little(1)
                             + little(orientation) + little(0x8769, 2) + little(4, 2) + little(1) + little(38)
                             + little(0);
    return head + little(1, 2) + little(0xa500, 2) + little(5, 2) + little(1) + little(56) + little(0)
           + little(gamma_tenths) + little(10);
}

/// A little-endian TIFF of 2x1 samples with further fields, each 12 bytes and by rising tags.
std::string tiff(const std::string& samples, unsigned bits, unsigned photometric, const std::string& late,
                 unsigned late_fields) {
    const unsigned fields = 8 + late_fields, data = 8 + 2 + 12 * fields + 4;
    const auto field = [](unsigned tag, unsigned type, unsigned value) {
        return little(tag, 2) + little(type, 2) + little(1) + little(value);
    };
    return "II*\0"s + little(8) + little(fields, 2) + field(256, 3, 2) + field(257, 3, 1)
           + field(258, 3, bits) + field(259, 3, 1) + field(262, 3, photometric) + field(273, 4, data)
           + field(278, 3, 1) + field(279, 4, static_cast<unsigned>(samples.size())) + late + little(0)
           + samples;
}

/// Display P3 as EXIF and TIFF state it: the white point, then red, green and blue, as shares of 10000.
std::string p3_rationals() {
    std::string text;
    for (const unsigned share : {3127, 3290, 6800, 3200, 2650, 6900, 1500, 600})
        text += little(share) + little(10000);
    return text;
}

/// A field whose values stand elsewhere.
std::string far_field(unsigned tag, unsigned type, std::size_t count, std::size_t at) {
    return little(tag, 2) + little(type, 2) + little(static_cast<unsigned>(count))
           + little(static_cast<unsigned>(at));
}

/// The reddest light of Display P3, by Rec. 709's primaries (SMPTE RP 431-2 and ITU-R BT.709, D65 both).
void check_p3_red(const ImageFile& file) {
    CHECK(file.image.values[0] == Approx(1.2249).margin(2e-3)); // profiles hold four decimals, and D50
    CHECK(file.image.values[1] == Approx(-0.0421).margin(2e-3));
    CHECK(file.image.values[2] == Approx(-0.0196).margin(2e-3));
}

} // namespace

TEST_CASE("Primaries and profiles of BMP, TIFF and EXIF become Rec. 709") {
    const std::string red_bmp("\0\0\xff\0", 4), red("\xff\0\0", 3);
    // Points of CIEXYZ in 2.30 fixed point.
    std::string endpoints;
    for (const double value : {0.48657, 0.22897, 0.0, 0.26567, 0.69174, 0.04511, 0.19822, 0.07929, 1.04394})
        endpoints += little(static_cast<unsigned>(std::lround(std::ldexp(value, 30))));
    check_p3_red(color_of(bmp(1, red_bmp, version_4(0, 1).replace(20, 36, endpoints))));

    const std::string profile = p3_profile(1);
    const std::string version_5 = version_4(0x4d424544, 0) + little(4) + little(124 + 4)
                                  + little(static_cast<unsigned>(profile.size())) + little(0);
    check_p3_red(color_of(bmp(1, red_bmp, version_5) + profile));

    const std::size_t behind_head = 8 + 2 + 2 * 12 + 4;
    const std::string exif_p3 = "II*\0"s + little(8) + little(2, 2) + far_field(318, 5, 2, behind_head)
                                + far_field(319, 5, 6, behind_head + 16) + little(0) + p3_rationals();
    check_p3_red(color_of(stored_png(1, 1, 8, 2, "\0"s + red, png_chunk("eXIf", exif_p3))));

    // Three channels, and what is said of them behind the samples.
    const std::size_t behind_samples = 8 + 2 + 12 * 11 + 4 + 6;
    std::string primaries =
        tiff(red + red, 8, 2,
             far_field(318, 5, 2, behind_samples) + far_field(319, 5, 6, behind_samples + 16), 3)
        + p3_rationals();
    const std::size_t strip = primaries.find(little(273, 2) + little(4, 2));
    primaries.insert(strip + 12, little(277, 2) + little(3, 2) + little(1) + little(3));
    check_p3_red(color_of(primaries));

    const std::string grey = grey_profile(1);
    const std::string profiled =
        tiff("\x80\x80", 8, 1, far_field(34675, 7, grey.size(), 8 + 2 + 12 * 9 + 4 + 2), 1) + grey;
    CHECK(color_of(profiled).image.values[0] == Approx(128 / 255.0).margin(1e-3));
}

TEST_CASE("BMP: rows from the top, calibrated colours, linked profiles, pixels that are not square") {
    const std::string two_rows("\0\0\xff\0\xff\0\0\0", 8);
    const std::vector<float> blue_below_red = {0, 0, 1, 1, 0, 0};
    CHECK(color_of(bmp(-2, two_rows)).image.values == blue_below_red);
    const std::string grey("\x80\x80\x80\0", 4);
    CHECK(color_of(bmp(1, grey, version_4(0, 1))).image.values[0] == Approx(128 / 255.0).margin(1e-6));
    CHECK(color_of(bmp(1, grey, version_4(0x73524742, 1))).image.values[0] == Approx(0.21586).margin(1e-4));
    CHECK(is_told(color_of(bmp(1, grey, version_4(0x4c494e4b, 0))), "ICC profile"));
    CHECK(is_told(color_of(bmp(1, grey, "", 1000, 2000)), "not square"));
    CHECK_FALSE(is_told(color_of(bmp(1, grey)), "not square"));
}

TEST_CASE("TGA: pixels from right to left, gamma and the kind of alpha of its extension area") {
    const std::string red_blue("\0\0\xff\xff\0\0", 6);
    CHECK(color_of(tga(2, red_blue, 24, 0x20)).image.values == std::vector<float>{1, 0, 0, 0, 0, 1});
    CHECK(color_of(tga(2, red_blue, 24, 0x30)).image.values == std::vector<float>{0, 0, 1, 1, 0, 0});
    const std::string grey("\x80\x80\x80", 3), half("\x40\x40\x40\x80", 4);
    CHECK(color_of(tga(1, grey, 24, 0, tga_extension(10, 0))).image.values[0]
          == Approx(128 / 255.0).margin(1e-6));
    CHECK(color_of(tga(1, grey, 24, 0, tga_extension(22, 0))).image.values[0]
          == Approx(0.21586).margin(1e-4));
    const ImageFile premultiplied = color_of(tga(1, half, 32, 8, tga_extension(0, 4)));
    CHECK(premultiplied.image.values[0] == Approx(0.21404).margin(1e-4)); // light of 64 / 128
    CHECK(premultiplied.coding.alpha == Coding::Alpha::straight);
    const ImageFile ignored = color_of(tga(1, half, 32, 8, tga_extension(0, 1)));
    CHECK(ignored.image.channels == 3);
    CHECK(is_told(ignored, "alpha"));
    CHECK(color_of(tga(1, half, 32, 8, tga_extension(0, 3))).image.channels == 4);
    CHECK(color_of(tga(1, grey + "\0"s, 32, 0)).image.channels == 3);
}

TEST_CASE("PSD: 16 bits, profile, orientation and pixel aspect; packed 16 bits are refused") {
    const std::string fine("\x80\x01\x80\x02\0\0\0\0\0\0\0\0", 12), codes("\x80\x90\0\0\0\0", 6);
    const ImageFile deep = read_image(ImageSource{"a", psd(16, fine)}, {.role = Role::data});
    CHECK(deep.coding.bits == 16);
    CHECK(deep.image.values[0] == static_cast<float>(0x8001 / 65535.0));
    CHECK_THROWS_WITH(color_of(psd(16, fine, "", 1)), Catch::Contains("run-length"));
    const ImageFile turned = color_of(psd(8, codes, psd_resource(1058, exif(6))));
    CHECK(turned.image.width == 1);
    CHECK(turned.image.height == 2);
    CHECK(is_told(color_of(psd(8, codes, psd_resource(1039, "no profile"))), "ICC profile"));
    const auto two = std::bit_cast<std::uint64_t>(2.0);
    const std::string aspect =
        big(1) + big(static_cast<unsigned>(two >> 32)) + big(static_cast<unsigned>(two));
    CHECK(is_told(color_of(psd(8, codes, psd_resource(1064, aspect))), "not square"));
}

TEST_CASE("TIFF: what libtiff converts is turned too; signed numbers are refused; a transfer table is told") {
    const auto orientation = [](unsigned value) {
        return little(274, 2) + little(3, 2) + little(1) + little(value);
    };
    // Of one bit, which libtiff converts: white, then black.
    const ImageFile turned = color_of(tiff("\x80\0"s, 1, 1, "", 0));
    CHECK(turned.image.width == 2);
    std::string upright = tiff("\x80\0"s, 1, 1, "", 0);
    const std::size_t strip = upright.find(little(273, 2) + little(4, 2));
    upright = tiff("\x80\0"s, 1, 1, "", 1);
    upright.insert(strip + 12, orientation(6));
    const ImageFile six = color_of(upright);
    REQUIRE(six.image.width == 1);
    REQUIRE(six.image.height == 2);
    CHECK(six.image.at(0, 1, 0) == 1);
    CHECK(six.image.at(0, 0, 0) == 0);
    const std::string format = little(339, 2) + little(3, 2) + little(1) + little(2);
    CHECK_THROWS_WITH(color_of(tiff("\x80\0"s, 8, 1, format, 1)), Catch::Contains("signed"));
}

TEST_CASE("PNG: EXIF's gamma, where no chunk says anything; what is not understood leaves the next word") {
    const std::string row("\0\x80\x80\x80", 4);
    const auto first_of = [&](const std::string& statements) {
        return color_of(stored_png(1, 1, 8, 2, row, statements)).image.values[0];
    };
    const std::string linear = png_chunk("gAMA", big(100000)), exif_linear = png_chunk("eXIf", exif(1, 10));
    const Approx light = Approx(128 / 255.0).margin(1e-6), srgb = Approx(0.21586).margin(1e-4);
    CHECK(first_of(exif_linear) == light);
    CHECK(first_of(png_chunk("sRGB", "\0"s) + exif_linear) == srgb);
    CHECK(first_of(png_chunk("cICP", "\1\x9\0\1"s) + linear) == light);
    CHECK(first_of(png_chunk("iCCP", "x\0\0no profile"s) + linear) == light);
    const std::string density = png_chunk("pHYs", big(1000) + big(2000) + '\0');
    CHECK(is_told(color_of(stored_png(1, 1, 8, 2, row, density)), "not square"));
}

TEST_CASE("PNM: one bit per pixel, further pictures, channels that are no grey or RGB") {
    CHECK(color_of("P1\n# bits\n3 1\n101\n").image.values == std::vector<float>{0, 1, 0});
    CHECK(color_of("P4 9 1\n\x80\x80").image.values == std::vector<float>{0, 1, 1, 1, 1, 1, 1, 1, 0});
    CHECK_THROWS_AS(color_of("P4 9 1\n\x80"), Error);
    CHECK(is_told(color_of("P5 1 1 255\nxP5 1 1 255\nx"), "several pictures"));
    CHECK_THROWS_WITH(color_of("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE CMYK\nENDHDR\nabcd"),
                      Catch::Contains("CMYK"));
}

TEST_CASE("PFM with a sign before its scale, HDR of any program and with blanks in FORMAT") {
    CHECK(color_of("Pf 1 1 +1.0\n\x3f\x80\0\0"s).image.values == std::vector<float>{1});
    const std::string pixel("\x80\x80\x80\x81", 4);
    CHECK(color_of("#?AUTOPANO\nFORMAT= 32-bit_rle_rgbe \n\n-Y 1 +X 1\n" + pixel).image.values[0] == 1);
}

TEST_CASE("A smaller map belongs to a photograph by its shape") {
    CHECK(belonging_of(Image(20, 10, 1), 60, 120, 6) == Belonging::stored);
    CHECK(belonging_of(Image(10, 20, 1), 60, 120, 6) == Belonging::turned);
    CHECK(belonging_of(Image(10, 10, 1), 60, 120, 6) == Belonging::unknown);
}
