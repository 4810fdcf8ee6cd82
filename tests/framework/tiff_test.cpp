// TIFF files, made by libtiff.
#include "icc_profiles.hpp"
#include "image_checks.hpp"

#include <image/srgb.hpp>

#include <tiffio.h>

#include <cmath>
#include <functional>

using namespace postfx;
using namespace postfx::testing;

namespace {

struct Kind {
    int bits = 8, channels = 3, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_RGB;
    bool planar = false, tiled = false;
    std::function<void(TIFF*)> set_up{};
};

/// `pixels`: as the file has them, top row first, a plane after the other if it is planar.
template<class Number>
void write_tiff(const std::filesystem::path& file, unsigned width, unsigned height, const Kind& kind,
                std::vector<Number> pixels) {
    TIFF* tiff = TIFFOpen(file.c_str(), "w");
    REQUIRE(tiff);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind.channels);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, kind.format);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind.photometric);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, kind.planar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
    if (kind.tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
    }
    if (kind.set_up) kind.set_up(tiff);
    const unsigned planes = kind.planar ? static_cast<unsigned>(kind.channels) : 1;
    const unsigned together = kind.planar ? 1 : static_cast<unsigned>(kind.channels);
    for (unsigned plane = 0; plane < planes; ++plane) {
        Number* from = pixels.data() + std::size_t{plane} * width * height;
        if (kind.tiled) {
            std::vector<Number> tile(16 * 16 * together);
            for (unsigned y = 0; y < height; ++y)
                std::copy_n(from + y * width * together, width * together, tile.begin() + y * 16 * together);
            TIFFWriteTile(tiff, tile.data(), 0, 0, 0, static_cast<std::uint16_t>(plane));
        } else {
            for (unsigned y = 0; y < height; ++y)
                TIFFWriteScanline(tiff, from + y * width * together, y, static_cast<std::uint16_t>(plane));
        }
    }
    TIFFClose(tiff);
}

} // namespace

TEST_CASE("TIFF: strips, tiles and planes of 8 and 16 bits") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.tif";
    // Two rows of one pixel: red on top.
    const std::vector<float> expected = {0, 0.2f, 1, 1, 0, 0};
    write_tiff<std::uint8_t>(file, 1, 2, {}, {255, 0, 0, 0, 51, 255});
    CHECK(read_image(file, {.role = Role::data}).image.values == expected);
    const ImageFile light = read_image(file);
    CHECK(light.coding.plain_srgb);
    CHECK(light.image.values[1] == static_cast<float>(srgb_to_linear(0.2)));
    write_tiff<std::uint8_t>(file, 1, 2, {.tiled = true}, {255, 0, 0, 0, 51, 255});
    CHECK(read_image(file, {.role = Role::data}).image.values == expected);
    write_tiff<std::uint8_t>(file, 1, 2, {.planar = true}, {255, 0, 0, 51, 0, 255});
    CHECK(read_image(file, {.role = Role::data}).image.values == expected);
    write_tiff<std::uint16_t>(file, 1, 2, {.bits = 16}, {65535, 0, 0, 0, 13107, 65535});
    CHECK(read_image(file, {.role = Role::data}).image.values == expected);
    write_tiff<std::uint8_t>(file, 2, 1, {.channels = 1, .photometric = PHOTOMETRIC_MINISWHITE}, {255, 204});
    CHECK(read_image(file, {.role = Role::data}).image.values == std::vector<float>{0, 0.2f});
}

TEST_CASE("TIFF: floats are light") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.tif";
    const Kind grey = {
        .bits = 32, .channels = 1, .format = SAMPLEFORMAT_IEEEFP, .photometric = PHOTOMETRIC_MINISBLACK};
    write_tiff<float>(file, 3, 1, grey, {0.5f, -2.0f, 1000.0f});
    const ImageFile single = read_image(file);
    CHECK(single.image.values == std::vector<float>{0.5f, -2.0f, 1000.0f});
    CHECK(single.coding.numbers == Coding::Numbers::single);
    Kind half = grey;
    half.bits = 16;
    write_tiff<std::uint16_t>(file, 3, 1, half, {0x3800, 0xc000, 0x0001});
    CHECK(read_image(file).image.values == std::vector<float>{0.5f, -2.0f, std::ldexp(1.0f, -24)});
}

TEST_CASE("TIFF: alpha, either kind") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.tif";
    const auto with_alpha = [](std::uint16_t kind) {
        return [kind](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind); };
    };
    write_tiff<std::uint8_t>(file, 1, 1, {.channels = 4, .set_up = with_alpha(EXTRASAMPLE_UNASSALPHA)},
                             {255, 51, 0, 51});
    const ImageFile straight = read_image(file, {.role = Role::data});
    CHECK(straight.coding.alpha == Coding::Alpha::straight);
    CHECK(straight.image.values == std::vector<float>{1, 0.2f, 0, 0.2f});
    write_tiff<std::uint8_t>(file, 1, 1, {.channels = 4, .set_up = with_alpha(EXTRASAMPLE_ASSOCALPHA)},
                             {51, 0, 51, 51});
    const ImageFile divided = read_image(file);
    CHECK(divided.coding.alpha == Coding::Alpha::straight);
    CHECK(divided.image.values == std::vector<float>{1, 0, 1, 0.2f});
    write_tiff<std::uint8_t>(file, 1, 1, {.channels = 4, .set_up = with_alpha(EXTRASAMPLE_UNSPECIFIED)},
                             {255, 51, 0, 9});
    const ImageFile other = read_image(file);
    CHECK(other.image.channels == 3);
    CHECK(other.warnings.size() == 1);
}

TEST_CASE("TIFF: profiles, inks, orientation, pages, palettes") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.tif";
    const std::string profile = p3_profile(1);
    const auto with_profile = [&](TIFF* tiff) {
        TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
    };
    write_tiff<std::uint8_t>(file, 1, 1, {.set_up = with_profile}, {255, 0, 0});
    CHECK(read_image(file).image.values[0] == Approx(1.22494).margin(1e-4));
    CHECK(read_image(file, {.role = Role::texture}).image.values == std::vector<float>{1, 0, 0});

    write_tiff<std::uint8_t>(file, 1, 1, {.channels = 4, .photometric = PHOTOMETRIC_SEPARATED},
                             {51, 0, 0, 26});
    const ImageFile inks = read_image(file);
    CHECK(inks.warnings.size() == 1);
    CHECK(linear_to_srgb(inks.image.values[0]) * 255 == Approx(183)); // 204 * 229 / 255

    const auto upright = [](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_RIGHTTOP); };
    write_tiff<std::uint8_t>(file, 2, 1, {.set_up = upright}, {255, 0, 0, 0, 0, 255});
    const ImageFile turned = read_image(file);
    REQUIRE((turned.image.width == 1 && turned.image.height == 2));
    CHECK(turned.image.at(0, 1, 0) == 1); // red on top
    CHECK(turned.shot.orientation == 6);

    std::vector<std::uint16_t> red(256), others(256);
    red[1] = 65535;
    const auto colors = [&](TIFF* tiff) {
        TIFFSetField(tiff, TIFFTAG_COLORMAP, red.data(), others.data(), others.data());
    };
    write_tiff<std::uint8_t>(file, 2, 1,
                             {.channels = 1, .photometric = PHOTOMETRIC_PALETTE, .set_up = colors}, {1, 0});
    CHECK(read_image(file).image.values == std::vector<float>{1, 0, 0, 0, 0, 0});
}

TEST_CASE("TIFF files that are cut off or lie about their size") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.tif";
    std::vector<std::uint8_t> pixels(3 * 16 * 16);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = static_cast<std::uint8_t>(i * i % 251);
    write_tiff<std::uint8_t>(file, 16, 16, {}, pixels);
    // Its directory lies at the end.
    check_truncated(directory, file, file_bytes(file).size(), 13);
    std::string bytes = file_bytes(file);
    const auto directory_at =
        static_cast<std::uint8_t>(bytes[4]) + 256u * static_cast<std::uint8_t>(bytes[5]);
    // The first two fields are the width and the height, their values 8 bytes into the 12 of each.
    for (const std::size_t at : {directory_at + 2u + 8, directory_at + 2u + 12 + 8})
        bytes.replace(at, 2, std::string("\0\x20", 2)); // 8192
    put_bytes(file, bytes);
    CHECK(read_error(file).find("can't hold") != std::string::npos);
}
