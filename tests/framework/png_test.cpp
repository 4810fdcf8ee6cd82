// PNG: what its chunks say of its pixels. Expected light: the standards' formulas, worked out beside.
#include "icc_profiles.hpp"
#include "image_checks.hpp"
#include "png_bytes.hpp"

#include <image/srgb.hpp>

#include <cmath>

using namespace postfx;
using namespace postfx::testing;

namespace {

std::string gamma_chunk(double gamma) {
    return png_chunk("gAMA", big_endian(static_cast<std::uint32_t>(std::lround(gamma * 1e5))));
}

std::string chromaticities_chunk(const std::vector<double>& white_red_green_blue) {
    std::string data;
    for (const double value : white_red_green_blue)
        data += big_endian(static_cast<std::uint32_t>(std::lround(value * 1e5)));
    return png_chunk("cHRM", data);
}

const std::vector<double> p3 = {0.3127, 0.3290, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060};

std::string cicp_chunk(int primaries, int transfer, int full_range) {
    return png_chunk("cICP", {static_cast<char>(primaries), static_cast<char>(transfer), 0,
                              static_cast<char>(full_range)});
}

std::string profile_chunk(const std::string& profile) {
    return png_chunk("iCCP", std::string("any name\0\0", 10) + stored_zlib(profile));
}

const std::string srgb_chunk = png_chunk("sRGB", std::string(1, '\0'));

ImageFile read_png(const std::string& bytes, Role role = Role::color) {
    return read_image(ImageSource{"a.png", bytes}, {.role = role});
}

/// One pixel of RGB codes.
ImageFile pixel(int r, int g, int b, const std::string& statements, Role role = Role::color) {
    const std::string row = {0, static_cast<char>(r), static_cast<char>(g), static_cast<char>(b)};
    return read_png(stored_png(1, 1, 8, 2, row, statements), role);
}

void check_pixel(const ImageFile& file, double r, double g, double b, double tolerance = 1e-6) {
    REQUIRE(file.image.channels == 3);
    CHECK(file.image.values[0] == Approx(r).margin(tolerance));
    CHECK(file.image.values[1] == Approx(g).margin(tolerance));
    CHECK(file.image.values[2] == Approx(b).margin(tolerance));
}

// Linear Display P3 red in Rec. 709: the matrices of both spaces from their chromaticities, with 10 digits.
constexpr double p3_red[] = {1.2249401763, -0.0420569547, -0.0196375546};

} // namespace

TEST_CASE("gAMA is the power of the codes, and 1 is light already") {
    const ImageFile linear = pixel(51, 102, 255, gamma_chunk(1));
    check_pixel(linear, 0.2, 0.4, 1);
    CHECK_FALSE(linear.coding.plain_srgb);
    CHECK(linear.honoured.size() == 1);
    check_pixel(pixel(51, 102, 255, gamma_chunk(0.5)), 0.04, 0.16, 1);
}

TEST_CASE("The gamma that writers of sRGB state is sRGB") {
    for (const double gamma : {0.45455, 0.45, 0.4545}) {
        const ImageFile file = pixel(51, 102, 255, gamma_chunk(gamma));
        CHECK(file.coding.plain_srgb);
        CHECK(file.image.values[0] == static_cast<float>(srgb_to_linear(51 / 255.0)));
    }
    CHECK_FALSE(pixel(51, 102, 255, gamma_chunk(1 / 1.8)).coding.plain_srgb);
}

TEST_CASE("cHRM: other primaries become Rec. 709") {
    check_pixel(pixel(255, 0, 0, gamma_chunk(1) + chromaticities_chunk(p3)), p3_red[0], p3_red[1], p3_red[2],
                1e-5);
    const ImageFile own =
        pixel(255, 0, 0, chromaticities_chunk({0.3127, 0.329, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06}));
    CHECK(own.coding.plain_srgb);
    const ImageFile bad = pixel(255, 0, 0, chromaticities_chunk({0.3, 0.3, 0, 0, 0, 0, 0, 0}));
    CHECK(bad.warnings.size() == 1);
    check_pixel(bad, 1, 0, 0);
    // White is white, whatever its colour was.
    check_pixel(
        pixel(255, 255, 255, chromaticities_chunk({0.3457, 0.3585, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06})), 1, 1,
        1, 1e-6);
}

TEST_CASE("cICP before iCCP before sRGB before gAMA and cHRM") {
    const std::string low = gamma_chunk(1) + chromaticities_chunk(p3);
    check_pixel(pixel(51, 0, 0, srgb_chunk + low), srgb_to_linear(0.2), 0, 0);
    check_pixel(pixel(51, 0, 0, low + srgb_chunk), srgb_to_linear(0.2), 0, 0);
    const double red = std::pow(0.2, 3);
    for (const std::string& statements :
         {profile_chunk(p3_profile(3)) + srgb_chunk + low, srgb_chunk + low + profile_chunk(p3_profile(3))})
        // Profiles round to 1/65536.
        check_pixel(pixel(51, 0, 0, statements), red * p3_red[0], red * p3_red[1], red * p3_red[2], 3e-5);
    check_pixel(pixel(51, 0, 0, srgb_chunk + low + profile_chunk(p3_profile(3)) + cicp_chunk(1, 8, 1)), 0.2,
                0, 0);
}

TEST_CASE("cICP: curves and primaries of video") {
    check_pixel(pixel(255, 0, 0, cicp_chunk(12, 8, 1)), p3_red[0], p3_red[1], p3_red[2], 1e-5);
    CHECK(pixel(255, 0, 0, cicp_chunk(1, 13, 1)).coding.plain_srgb);
    // Rec. 709: ((0.4 + 0.099) / 1.099)^(1 / 0.45)
    check_pixel(pixel(102, 102, 102, cicp_chunk(1, 1, 1)), 0.1730, 0.1730, 0.1730, 1e-4);
    // ST 2084: the code 0.5 is 92.2457 cd/m2 and 1 is 10000; 203 are 1.
    const ImageFile pq = read_png(stored_png(1, 1, 16, 0, std::string("\0\x80\0", 3), cicp_chunk(9, 16, 1)));
    CHECK(pq.image.values[0] == Approx(92.2457 / 203).epsilon(1e-3)); // the code is 0x8000 / 0xffff
    check_pixel(pixel(255, 255, 255, cicp_chunk(9, 16, 1)), 10000 / 203.0, 10000 / 203.0, 10000 / 203.0,
                1e-3);
    // HLG: half the signal is 1/12 of the scene's largest light, three quarters 0.26496: white; 191 is a little less.
    check_pixel(pixel(191, 191, 191, cicp_chunk(1, 18, 1)), 0.9950, 0.9950, 0.9950, 1e-4);
    // Narrow range: 16 is black, 235 white.
    check_pixel(pixel(16, 235, 125, cicp_chunk(1, 8, 0)), 0, 1, 109 / 219.0);
    const ImageFile unknown = pixel(51, 0, 0, cicp_chunk(99, 13, 1));
    CHECK(unknown.warnings.size() == 1);
    check_pixel(unknown, srgb_to_linear(0.2), 0, 0);
}

TEST_CASE("A profile that is sRGB keeps every code, a damaged one is told of") {
    const std::string srgb = bytes_of(cmsCreate_sRGBProfile());
    const ImageFile plain = pixel(51, 102, 3, profile_chunk(srgb));
    CHECK(plain.coding.plain_srgb);
    CHECK(plain.image.values[2] == static_cast<float>(srgb_to_linear(3 / 255.0)));
    for (const std::string& damaged : {srgb.substr(0, 200), std::string("no profile")}) {
        const ImageFile file = pixel(51, 0, 0, profile_chunk(damaged));
        CHECK(file.warnings.size() == 1);
        check_pixel(file, srgb_to_linear(0.2), 0, 0);
    }
    CHECK(pixel(51, 0, 0, profile_chunk(grey_profile(2))).warnings.size() == 1);
    const ImageFile grey =
        read_png(stored_png(1, 1, 8, 4, std::string("\0\x33\x80", 3), profile_chunk(grey_profile(2))));
    REQUIRE(grey.image.channels == 2);
    CHECK(grey.image.values[0] == Approx(0.04).margin(1e-5));
    CHECK(grey.image.values[1] == static_cast<float>(128 / 255.0));
}

TEST_CASE("Measurements and textures are numbers, whatever is said of colours") {
    for (const Role role : {Role::depth, Role::normal, Role::data, Role::texture})
        for (const std::string& statements :
             {gamma_chunk(1), cicp_chunk(9, 16, 0), profile_chunk(p3_profile(3))})
            check_pixel(pixel(51, 102, 255, statements, role), 0.2, 0.4, 1, 1e-7);
}

TEST_CASE("Palettes, few bits, transparency and interlace are spread out") {
    const std::string palette = png_chunk("PLTE", std::string("\xff\0\0\0\xff\0", 6));
    const std::string alphas = png_chunk("tRNS", std::string("\xff\x40", 2));
    // Two pixels of one bit each: entries 1 and 0.
    const ImageFile file =
        read_png(stored_png(2, 1, 1, 3, std::string("\0\x80", 2), palette + alphas), Role::data);
    CHECK(file.image.channels == 4);
    CHECK(file.coding.alpha == Coding::Alpha::straight);
    CHECK(file.image.values == std::vector<float>{0, 1, 0, static_cast<float>(64 / 255.0), 1, 0, 0, 1});
    const ImageFile grey = read_png(stored_png(4, 1, 2, 0, std::string("\0\x1b", 2)), Role::data);
    CHECK(grey.image.values
          == std::vector<float>{0, static_cast<float>(85 / 255.0), static_cast<float>(170 / 255.0), 1});
}

TEST_CASE("PNG: what else is said") {
    const std::string density = png_chunk("pHYs", big_endian(1000) + big_endian(2000) + std::string(1, '\1'));
    const ImageFile wide = pixel(0, 0, 0, density);
    REQUIRE(wide.shot.pixel_aspect_ratio);
    CHECK(*wide.shot.pixel_aspect_ratio == 2);
    const std::string animated = png_chunk("acTL", big_endian(2) + big_endian(0));
    CHECK(pixel(0, 0, 0, animated).warnings.size() == 1);
    // EXIF orientation 6, big endian: two pixels, red on the left, become red on top.
    const std::string exif("MM\0*\0\0\0\x08\0\1\x01\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0", 26);
    const std::string row("\0\xff\0\0\0\0\xff", 7);
    const std::string bytes = stored_png(2, 1, 8, 2, row, png_chunk("eXIf", exif));
    const ImageFile upright = read_png(bytes);
    REQUIRE((upright.image.width == 1 && upright.image.height == 2));
    CHECK(upright.image.at(0, 1, 0) == 1);
    CHECK(upright.image.at(0, 0, 2) == 1);
    CHECK(upright.shot.orientation == 6);
    CHECK(read_png(bytes, Role::data).image.height == 2);
    CHECK(read_png(bytes, Role::texture).image.height == 1);
}

TEST_CASE("Damaged PNG files") {
    const std::string row("\0\xff\0\0", 4);
    const std::string good = stored_png(1, 1, 8, 2, row);
    std::string flipped = good;
    flipped[good.find("IDAT") + 12] ^= 1;
    CHECK_THROWS_AS(read_png(flipped), Error);
    std::string bad_gamma = stored_png(1, 1, 8, 2, row, gamma_chunk(1));
    bad_gamma[bad_gamma.find("gAMA") + 5] ^= 1;
    const ImageFile file = read_png(bad_gamma);
    CHECK(file.coding.plain_srgb);
    CHECK(file.warnings.size() == 1);
    // A head that no amount of compression makes true is refused before anything of its size is allocated.
    CHECK_THROWS_WITH(read_png(stored_png(16384, 16384, 8, 6, row)), Catch::Contains("can't hold"));
    const ImageFile cut = read_png(good.substr(0, good.size() - 12));
    CHECK(cut.warnings.size() == 1);
}

TEST_CASE("PNG files of ours say that they are sRGB, with 8 and 16 bits") {
    const TemporaryDirectory directory;
    Image image(2, 1, 3);
    image.values = {0.5f, 0.001f, 1.0f, 0.25f, 0.0f, 2.0f};
    write_image(directory / "a.png", image, {.bits = 16});
    const ImageFile deep = read_image(directory / "a.png");
    CHECK(deep.coding.bits == 16);
    CHECK(deep.coding.plain_srgb);
    // Half a code of 65535, where the curve is steepest (12.92) and less elsewhere.
    for (std::size_t i = 0; i < 5; ++i)
        CHECK(std::fabs(deep.image.values[i] - image.values[i]) <= 1.25 / 65535);
    CHECK(deep.image.values[5] == 1);
    for (const int bits : {8, 16}) {
        write_image(directory / "b.png", image, {.bits = bits});
        const std::string bytes = file_bytes(directory / "b.png");
        CHECK(bytes.find("sRGB") != std::string::npos);
        CHECK(bytes.find("gAMA") != std::string::npos);
    }
}
