// Colour spaces by primaries and white, against figures that their standards print.
#include <image/color_space.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace postfx;

namespace {

constexpr Chromaticities xyz = {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0, 1 / 3.0}};
constexpr Chromaticities rec2020 = {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}};
constexpr Chromaticities aces_ap0 = {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, {0.32168, 0.33767}};

/// `digits`: how the figures that are compared with were rounded.
void check_matrix(const std::optional<ColorMatrix>& matrix, const ColorMatrix& expected, double digits) {
    REQUIRE(matrix);
    for (std::size_t i = 0; i < 9; ++i) {
        CAPTURE(i);
        CHECK((*matrix)[i] == Approx(expected[i]).margin(digits));
    }
}

} // namespace

TEST_CASE("XYZ of colour spaces as their standards print it") {
    // IEC 61966-2-1: four digits, from the same primaries.
    check_matrix(matrix_to_xyz(rec709_chromaticities),
                 {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505}, 1e-4);
    // SMPTE ST 2065-1:2012, section 4.4.2: ten digits.
    check_matrix(
        matrix_to_xyz(aces_ap0),
        {0.9525523959, 0, 0.0000936786, 0.3439664498, 0.7281660966, -0.0721325464, 0, 0, 1.0088251844}, 1e-9);
    // X and Z themselves have y = 0.
    check_matrix(matrix_to_xyz(xyz), {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1e-12);
}

TEST_CASE("Rec. 2020 to Rec. 709 as ITU-R BT.2087 prints it") {
    const ColorMatrix printed = {1.6605,  -0.5876, -0.0728, -0.1246, 1.1329,
                                 -0.0083, -0.0182, -0.1006, 1.1187};
    // The white is the same: there is nothing to adapt.
    for (const Adaptation adaptation : {Adaptation::none, Adaptation::bradford})
        check_matrix(matrix_to_rec709(rec2020, adaptation), printed, 1e-4);
}

TEST_CASE("White keeps its light, or becomes white") {
    const auto white = [](const Chromaticities& space, Adaptation adaptation) {
        Image image(1, 1, 3, 1.0f);
        convert_colors(image, *matrix_to_rec709(space, adaptation));
        return image.values;
    };
    for (const Chromaticities& space : {xyz, aces_ap0}) {
        for (const float value : white(space, Adaptation::bradford))
            CHECK(value == Approx(1).margin(1e-6)); // a float's rounding
        const auto light = white(space, Adaptation::none);
        CHECK(light[0] > 1.02); // both whites are redder than D65
        CHECK(light[2] < 0.98);
        // Its luminance stays 1.
        CHECK(0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2] == Approx(1).margin(2e-4));
    }
}

TEST_CASE("Alpha is not colour") {
    Image image(1, 1, 4);
    image.values = {0.4124f, 0.2126f, 0.0193f, 0.25f};
    convert_colors(image, *matrix_to_rec709(xyz, Adaptation::none));
    const float expected[4] = {1, 0, 0, 0.25f};
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(image.values[i] == Approx(expected[i]).margin(3e-4)); // XYZ was given with four digits
}

TEST_CASE("Rec. 709 with the rounding of files") {
    Chromaticities space = rec709_chromaticities;
    CHECK(is_rec709(space));
    space.white = {0.31271, 0.32902};
    CHECK(is_rec709(space));
    space.white = {0.3140, 0.3510}; // DCI
    CHECK_FALSE(is_rec709(space));
    CHECK_FALSE(is_rec709(rec2020));
}

TEST_CASE("Numbers that make no colour space") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Chromaticities& good = rec709_chromaticities;
    const auto refused = [](const Chromaticities& space) {
        return !matrix_to_xyz(space) && !matrix_to_rec709(space, Adaptation::none)
               && !matrix_to_rec709(space, Adaptation::bradford);
    };
    CHECK(refused({}));
    CHECK(refused({good.red, good.red, good.blue, good.white}));
    CHECK(refused({{0, 0}, {0.2, 0.2}, {0.4, 0.4}, {0.3, 0.3}})); // on a line
    CHECK(refused({{nan, 0.3}, good.green, good.blue, good.white}));
    CHECK(refused({good.red, good.green, good.blue, {0.3, 0}}));
    CHECK(refused({good.red, good.green, good.blue, {0.7, 0.29}})); // white outside
    CHECK(refused({{1e30, 0.3}, good.green, good.blue, good.white}));
    CHECK(refused({{std::numeric_limits<double>::infinity(), 0.3}, good.green, good.blue, good.white}));
}
