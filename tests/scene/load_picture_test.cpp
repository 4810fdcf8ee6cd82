// Textures of models: the codes of their files.
#include <scene/assets.hpp>

#include <image/files.hpp>
#include <postfx/error.hpp>
#include <temporary_directory.hpp>

#include <catch2/catch.hpp>

using namespace postfx;
using namespace postfx::host;
using postfx::testing::TemporaryDirectory;

TEST_CASE("A texture's codes are those of its file") {
    const TemporaryDirectory directory;
    BasicImage<std::uint8_t> codes(256, 1, 4);
    for (std::size_t i = 0; i < codes.values.size(); ++i)
        codes.values[i] = static_cast<std::uint8_t>(i / 4 + i % 4 * 50);
    write_codes(directory / "a.png", codes);
    for (const bool srgb : {false, true}) {
        const PicturePtr picture = load_picture(directory / "a.png", srgb);
        CHECK(picture->rgba == codes.values);
        CHECK(picture->srgb == srgb);
    }
    BasicImage<std::uint8_t> grey(2, 1, 1);
    grey.values = {7, 200};
    write_codes(directory / "g.png", grey);
    CHECK(load_picture(directory / "g.png", true)->rgba
          == std::vector<std::uint8_t>{7, 7, 7, 255, 200, 200, 200, 255});
}

TEST_CASE("A texture of light becomes codes as sRGB shows it, or numbers where it is data") {
    const TemporaryDirectory directory;
    write_image(directory / "a.exr", Image(1, 1, 3, 0.5f));
    CHECK(load_picture(directory / "a.exr", true)->rgba[0] == 188); // round(255 * 0.73536)
    CHECK(load_picture(directory / "a.exr", false)->rgba[0] == 128);
    CHECK_THROWS_AS(load_picture(directory / "missing.png", true), Error);
}
