// TGA, BMP and PNM, which models bring.
#include "image_checks.hpp"

using namespace postfx;
using namespace postfx::testing;

namespace {

std::string little(unsigned value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i)
        text += static_cast<char>(value >> (8 * i));
    return text;
}

/// Uncompressed RGB, bottom row first.
std::string tga(unsigned width, unsigned height, const std::string& pixels) {
    return std::string("\0\0\2\0\0\0\0\0\0\0\0\0", 12) + little(width, 2) + little(height, 2) + "\x18" + '\0'
           + pixels;
}

/// Of 24 bits, bottom row first; `pixels` with rows of whole words.
std::string bmp(unsigned width, unsigned height, const std::string& pixels) {
    return "BM" + little(static_cast<unsigned>(54 + pixels.size()), 4) + little(0, 4) + little(54, 4)
           + little(40, 4) + little(width, 4) + little(height, 4) + little(1, 2) + little(24, 2)
           + std::string(24, '\0') + pixels;
}

Image data_of(const std::string& bytes) {
    return read_image(ImageSource{"a", bytes}, {.role = Role::data}).image;
}

} // namespace

TEST_CASE("TGA, BMP and PNM are read by content") {
    const std::vector<float> blue_then_red = {0, 0, 1, 1, 0, 0}; // bottom row first
    CHECK(data_of(tga(1, 2, std::string("\xff\0\0\0\0\xff", 6))).values == blue_then_red);
    CHECK(data_of(bmp(1, 2, std::string("\xff\0\0\0\0\0\xff\0", 8))).values == blue_then_red);
    CHECK(data_of("P6\n1 2\n255\n" + std::string("\xff\0\0\0\0\xff", 6)).values == blue_then_red);
    const ImageFile deep = read_image(ImageSource{"a", "P5 2 1 65535\n" + std::string("\x12\x34\xff\xff", 4)},
                                      {.role = Role::data});
    CHECK(deep.coding.bits == 16);
    CHECK(deep.image.values == std::vector<float>{static_cast<float>(0x1234 / 65535.0), 1});
}

TEST_CASE("TGA, BMP and PNM that are cut off are refused, and so are absurd sizes") {
    const std::string pixels(3 * 64 * 64, '\x55');
    for (const std::string& whole : {tga(64, 64, pixels), bmp(64, 64, pixels), "P6\n64 64\n255\n" + pixels})
        for (std::size_t size = 0; size < whole.size(); size += 31) {
            CAPTURE(size);
            CHECK_THROWS_AS(data_of(whole.substr(0, size)), Error);
        }
    CHECK_THROWS_WITH(data_of(tga(60000, 60000, pixels)), Catch::Contains("absurd size"));
    CHECK_THROWS_WITH(data_of(bmp(40000, 1, pixels)), Catch::Contains("absurd size"));
}

TEST_CASE("PNM: the largest sample is 1, whatever it is") {
    CHECK(data_of("P2 # a comment\n2 1\n31\n31 0\n").values == std::vector<float>{1, 0});
    CHECK(data_of("P3 1 1 10 5 0 10").values == std::vector<float>{0.5f, 0, 1});
    CHECK(data_of("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n"
                  + std::string("\xff\0\0\x33", 4))
              .values
          == std::vector<float>{1, 0, 0, 0.2f});
    CHECK_THROWS_AS(data_of("P5 1 1 31\n\x20"), Error);
    CHECK_THROWS_AS(data_of("P5 1 1 70000\n12"), Error);
    CHECK_THROWS_AS(data_of("P7\nWIDTH 1\n"), Error);
}
