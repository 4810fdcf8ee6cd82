// LDR-FLIP against published numbers, closed forms and its own formulas written down plainly.
#include <catch2/catch.hpp>

#include <image/cielab.hpp>
#include <image/flip.hpp>
#include <image/heat_colors.hpp>
#include <postfx/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

using namespace postfx;

namespace {

using Color = std::array<double, 3>;

/// float64 against float64 summed in another order. The feature metric takes a square root, so the 1e-16 that
/// rounding leaves of an edge in a plain picture becomes 1e-8 of the error's exponent.
constexpr double rounding = 1e-7;

Image filled(int width, int height, const Color& color) {
    Image image(width, height, 3);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<float>(color[i % 3]);
    return image;
}

Image noise(int width, int height, std::uint32_t state) {
    Image image(width, height, 3);
    for (float& value : image.values) {
        state = state * 1664525u + 1013904223u;
        value = static_cast<float>(state >> 8) / 16777216.0f;
    }
    return image;
}

// The paper's formulas once more, from numbers to numbers and by two-dimensional sums, sharing nothing with the
// library. Linear sRGB to X, Y, Z in units of the white:
Color white_relative(const Color& rgb) {
    const double x[3] = {10135552.0, 8788810.0, 4435075.0}, y[3] = {2613072.0, 8788810.0, 887015.0},
                 z[3] = {1425312.0, 8788810.0, 70074185.0};
    const auto row = [&](const double* m) {
        return (m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]) / (m[0] + m[1] + m[2]);
    };
    return {row(x), row(y), row(z)};
}

Color lab_of(const Color& rgb) {
    Color f = white_relative(rgb);
    for (double& t : f)
        t = t > 216.0 / 24389 ? std::pow(t, 1.0 / 3) : (24389.0 / 27 * t + 16) / 116;
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

double plain_color_error(const Color& rgb_a, const Color& rgb_b) {
    const auto powered_hyab = [](const Color& u, const Color& v) {
        const Color a = lab_of(u), b = lab_of(v);
        const double da = a[0] * a[1] / 100 - b[0] * b[1] / 100, db = a[0] * a[2] / 100 - b[0] * b[2] / 100;
        return std::pow(std::fabs(a[0] - b[0]) + std::sqrt(da * da + db * db), 0.7);
    };
    const double error = powered_hyab(rgb_a, rgb_b), largest = powered_hyab({0, 1, 0}, {0, 0, 1});
    if (error < 0.4 * largest) return error * 0.95 / (0.4 * largest);
    return 0.95 + 0.05 * (error - 0.4 * largest) / (0.6 * largest);
}

/// Solves for linear sRGB by Cramer's rule from white-relative X, Y, Z.
Color rgb_of(const Color& xyz) {
    Color columns[3] = {white_relative({1, 0, 0}), white_relative({0, 1, 0}), white_relative({0, 0, 1})};
    const auto determinant = [](const Color& a, const Color& b, const Color& c) {
        return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
               + c[0] * (a[1] * b[2] - a[2] * b[1]);
    };
    const double whole = determinant(columns[0], columns[1], columns[2]);
    return {determinant(xyz, columns[1], columns[2]) / whole,
            determinant(columns[0], xyz, columns[2]) / whole,
            determinant(columns[0], columns[1], xyz) / whole};
}

/// One pixel of the picture filtered with weight(dx, dy), the border going on.
template<class Weight>
Color filtered(const Image& image, int x, int y, int radius, Weight weight) {
    Color result{};
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const float* rgb =
                image.pixel(std::clamp(x + dx, 0, image.width - 1), std::clamp(y + dy, 0, image.height - 1));
            const Color xyz = white_relative({rgb[0], rgb[1], rgb[2]}), w = weight(dx, dy);
            result[0] += w[0] * xyz[1];
            result[1] += w[1] * (xyz[0] - xyz[1]);
            result[2] += w[2] * (xyz[1] - xyz[2]);
        }
    return result;
}

Color plain_seen(const Image& image, int x, int y, double ppd) {
    const double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const auto raw = [&](int dx, int dy) {
        const double d2 = (dx * dx + dy * dy) / (ppd * ppd);
        const auto g = [&](double a, double b) {
            return a * std::sqrt(pi / b) * std::exp(-pi * pi * d2 / b);
        };
        return Color{g(1, 0.0047), g(1, 0.0053), g(34.1, 0.04) + g(13.5, 0.025)};
    };
    Color total{};
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            for (std::size_t c = 0; c < 3; ++c)
                total[c] += raw(dx, dy)[c];
    const Color o = filtered(image, x, y, radius, [&](int dx, int dy) {
        const Color w = raw(dx, dy);
        return Color{w[0] / total[0], w[1] / total[1], w[2] / total[2]};
    });
    Color rgb = rgb_of({o[0] + o[1], o[0], o[0] - o[2]});
    for (double& light : rgb)
        light = std::clamp(light, 0.0, 1.0);
    return rgb;
}

/// Response to the first (order 1) or second derivative of a Gaussian.
double plain_feature(const Image& image, int x, int y, double ppd, int order) {
    const double s = 0.041 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * s));
    const auto raw = [&](int i, int j) {
        return (order == 1 ? -i : i * i / (s * s) - 1) * std::exp(-(i * i + j * j) / (2 * s * s));
    };
    double positive = 0, negative = 0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i)
            (raw(i, j) > 0 ? positive : negative) += std::fabs(raw(i, j));
    const auto weight = [&](int i, int j) { return raw(i, j) / (raw(i, j) > 0 ? positive : negative); };
    const auto response = [&](auto turned) {
        return filtered(image, x, y, radius, [&](int dx, int dy) { return Color{turned(dx, dy), 0, 0}; })[0];
    };
    return std::hypot(response([&](int dx, int dy) { return weight(dx, dy); }),
                      response([&](int dx, int dy) { return weight(dy, dx); }));
}

double plain_flip(const Image& a, const Image& b, int x, int y, double ppd) {
    double feature = 0;
    for (int order : {1, 2})
        feature = std::max(
            feature, std::fabs(plain_feature(a, x, y, ppd, order) - plain_feature(b, x, y, ppd, order)));
    return std::pow(plain_color_error(plain_seen(a, x, y, ppd), plain_seen(b, x, y, ppd)),
                    1 - std::sqrt(feature / std::sqrt(2.0)));
}

} // namespace

TEST_CASE("FLIP of equal pictures is 0") {
    const Image image = noise(GENERATE(1, 7, 40), GENERATE(1, 23), 1);
    const FlipError error = flip(image, image, Encoding::srgb);
    CHECK(error.mean == 0);
    CHECK(error.max == 0);
    CHECK(error.weighted_median == 0);
    CHECK(error.clipped == 0);
}

TEST_CASE("The default viewing condition is the paper's") {
    CHECK(default_pixels_per_degree == Approx(67.0206432766));
}

TEST_CASE("FLIP gives a published number") {
    // OpenImageIO, testsuite/flip/ref/out.txt: LDR-FLIP of linear grey 0.1 and 0.9, stored as half floats, at the
    // default viewing condition is 0.9514; that implementation is checked against the authors'.
    const FlipError error =
        flip(Image(64, 64, 3, 0.099975586f), Image(64, 64, 3, 0.89990234f), Encoding::linear);
    CHECK(error.mean == Approx(0.9514).margin(0.00005)); // as many digits as are published
    CHECK(error.max == Approx(0.9514).margin(0.00005));
}

TEST_CASE("FLIP of plain colours is the colour metric alone") {
    const auto [a, b] = GENERATE(std::pair<Color, Color>{{0, 0, 0}, {1, 1, 1}}, // 0.967: not the largest
                                 std::pair<Color, Color>{{0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}},
                                 std::pair<Color, Color>{{0.5, 0.25, 0}, {0.5, 0.25, 0.125}},
                                 std::pair<Color, Color>{{1, 0, 0}, {0, 1, 1}},
                                 std::pair<Color, Color>{{0.001953125, 0, 0}, {0, 0, 0.001953125}});
    const FlipError error = flip(filled(9, 5, a), filled(9, 5, b), Encoding::linear);
    CHECK(error.mean == Approx(plain_color_error(a, b)).epsilon(rounding));
    CHECK(error.min == Approx(error.max).epsilon(rounding));
    CHECK(error.weighted_median == Approx(error.mean).epsilon(rounding));
}

TEST_CASE("The largest error is that of green against blue: 1") {
    CHECK(flip(filled(5, 5, {0, 1, 0}), filled(5, 5, {0, 0, 1}), Encoding::linear).mean
          == Approx(1).epsilon(rounding));
    CHECK(flip(noise(31, 17, 1), noise(31, 17, 2), Encoding::srgb).max <= 1);
}

TEST_CASE("FLIP is its published formulas, pixel by pixel") {
    // 67 pixels per degree: filters wider than the picture, so the border counts everywhere.
    const double ppd = GENERATE(20.0, 67.0);
    const Image a = noise(13, 11, 1), b = noise(13, 11, 2);
    const FlipError error = flip(a, b, Encoding::linear, ppd);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            // the map is float32
            REQUIRE(error.map.at(x, y, 0) == Approx(plain_flip(a, b, x, y, ppd)).epsilon(1e-6));
}

TEST_CASE("FLIP is symmetric and grows with the difference") {
    const Image a = noise(31, 17, 1), b = noise(31, 17, 2);
    CHECK(flip(a, b, Encoding::srgb).map.values == flip(b, a, Encoding::srgb).map.values);
    double before = 0;
    for (float grey : {0.5001f, 0.51f, 0.55f, 0.6f, 0.8f, 1.0f}) {
        const double mean = flip(Image(8, 8, 1, 0.5f), Image(8, 8, 1, grey), Encoding::srgb).mean;
        CHECK(mean > before);
        before = mean;
    }
}

TEST_CASE("FLIP sees an edge that only one picture has") {
    constexpr int width = 81, height = 5;
    const Image flat(width, height, 1, 0.5f);
    Image step = flat, opposite = flat;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            step.at(x, y, 0) = x < width / 2 ? 0.375f : 0.625f;
            opposite.at(x, y, 0) = x < width / 2 ? 0.625f : 0.375f;
        }
    const Image only_one = flip(flat, step, Encoding::linear).map;
    const Color grey{0.5, 0.5, 0.5}, dark{0.375, 0.375, 0.375};
    // Farther from the edge than any filter reaches: colours alone.
    CHECK(only_one.at(5, 2, 0) == Approx(plain_color_error(grey, dark)).epsilon(1e-6));
    CHECK(only_one.at(width / 2 - 4, 2, 0) > 1.2 * only_one.at(5, 2, 0));
    // An edge in both, though of other sign, is no missing feature: nothing stands out.
    const Image both = flip(step, opposite, Encoding::linear).map;
    CHECK(*std::max_element(both.values.begin(), both.values.end()) <= both.at(5, 2, 0) * 1.000001f);
}

TEST_CASE("FLIP sees a lone point as wide as the eye does") {
    const Image black(61, 61, 3);
    Image point = black;
    std::fill_n(point.pixel(30, 30), 3, 1.0f);
    const FlipError near = flip(black, point, Encoding::linear),
                    far = flip(black, point, Encoding::linear, 200);
    CHECK(near.map.at(30, 30, 0) > 0.2);
    CHECK(near.map.at(30, 30, 0) == static_cast<float>(near.max));
    CHECK(near.map.at(30, 30 + 11, 0) == 0); // beyond 3 deviations of both kinds of filters: 10 pixels
    CHECK(near.map.at(30, 30 + 5, 0) > 0);
    CHECK(far.max < near.max); // smaller pixels hide it
}

TEST_CASE("FLIP pools errors by their weight") {
    const Image a(40, 3, 1, 0.5f);
    Image b = a;
    b.at(20, 1, 0) = 0.9f;
    const FlipError error = flip(a, b, Encoding::srgb);
    CHECK(error.min == 0);
    CHECK(error.weighted_first_quartile > error.mean); // most pixels have no error and don't count
    CHECK(error.weighted_first_quartile <= error.weighted_median);
    CHECK(error.weighted_median <= error.weighted_third_quartile);
    CHECK(error.weighted_third_quartile <= error.max);
    // The definition, on the map itself.
    double total = 0, up_to_median = 0;
    for (float value : error.map.values) {
        total += value;
        if (value < static_cast<float>(error.weighted_median)) up_to_median += value;
    }
    CHECK(up_to_median <= total / 2);
    CHECK(up_to_median + 12 * error.weighted_median > total / 2); // 12: more ties than mirroring makes
}

TEST_CASE("FLIP never skips a pixel silently") {
    const float bad =
        GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
    Image a = noise(9, 9, 1), b = a;
    b.at(4, 5, 1) = bad;
    if (GENERATE(false, true)) a.at(4, 5, 1) = bad;
    const FlipError error = flip(a, b, Encoding::linear);
    CHECK(error.non_finite == 1);
    for (double pooled : {error.mean, error.min, error.max, error.weighted_median,
                          error.weighted_first_quartile, error.weighted_third_quartile})
        CHECK(std::isinf(pooled));
    CHECK(std::isinf(error.map.at(4, 5, 0)));
    CHECK(std::isfinite(error.map.at(4, 4, 0)));

    Image bright = noise(9, 9, 1), white = bright;
    bright.at(0, 0, 0) = 7.0f;
    white.at(0, 0, 0) = 1.0f;
    const FlipError clipped = flip(bright, white, Encoding::linear);
    CHECK(clipped.clipped == 1);
    CHECK(clipped.max == 0); // a display shows both as 1
}

TEST_CASE("sRGB codes and their light are the same picture") {
    // 0.5 is not representable alike in both; srgb 0.7353569 is linear 0.5 to float32.
    const double by_codes = flip(Image(4, 4, 3, 0.7353569f), Image(4, 4, 3), Encoding::srgb).mean;
    CHECK(by_codes
          == Approx(flip(Image(4, 4, 3, 0.5f), Image(4, 4, 3), Encoding::linear).mean).epsilon(1e-6));
    CHECK(flip(Image(4, 4, 4, 0.5f), Image(4, 4, 1, 0.5f), Encoding::srgb).mean == 0); // alpha is left out
}

TEST_CASE("What FLIP refuses") {
    const Image image(2, 2, 3);
    CHECK_THROWS_AS(flip(image, Image(2, 3, 3), Encoding::srgb), Error);
    CHECK_THROWS_AS(flip(Image(), Image(), Encoding::srgb), Error);
    CHECK_THROWS_AS(flip(image, image, Encoding::srgb, 0.5), Error);
    CHECK_THROWS_AS(flip(image, image, Encoding::srgb, std::nan("")), Error);
}

TEST_CASE("L*a*b* of known colours, there and back") {
    // L* of 18 % grey is 49.496, of the knee 216/24389 it is 8; greys have no chroma.
    CHECK(xyz_to_lab(linear_to_xyz({0.18, 0.18, 0.18}))[0] == Approx(49.4961).epsilon(1e-6));
    CHECK(xyz_to_lab(linear_to_xyz({216.0 / 24389, 216.0 / 24389, 216.0 / 24389}))[0] == Approx(8));
    CHECK(xyz_to_lab(linear_to_xyz({0.3, 0.3, 0.3}))[1] == Approx(0).margin(1e-12));
    // Published values of sRGB red (D65): 53.24, 80.09, 67.20; a white rounded otherwise moves them by 0.02.
    const Triple red = xyz_to_lab(linear_to_xyz({1, 0, 0}));
    CHECK(red[0] == Approx(53.24).margin(0.02));
    CHECK(red[1] == Approx(80.09).margin(0.02));
    CHECK(red[2] == Approx(67.20).margin(0.02));
    for (const Triple& color : {Triple{0.2, 0.9, 0.001}, Triple{0, 0, 1}, Triple{1, 1, 1}}) {
        const Triple back = xyz_to_linear(lab_to_xyz(xyz_to_lab(linear_to_xyz(color))));
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(back[c] == Approx(color[c]).margin(1e-13));
    }
}

TEST_CASE("Heat colours grow lighter from black to white") {
    Image errors(256, 1, 1);
    for (int x = 0; x < 256; ++x)
        errors.at(x, 0, 0) = static_cast<float>(x) / 255;
    const std::vector<std::uint8_t> codes = heat_colors(errors);
    CHECK((codes[0] == 0 && codes[1] == 0 && codes[2] == 0));
    CHECK(std::min({codes[765], codes[766], codes[767]}) > 240);
    double before = -1;
    for (std::size_t i = 0; i < 256; ++i) {
        const double luma = 0.2126 * codes[3 * i] + 0.7152 * codes[3 * i + 1] + 0.0722 * codes[3 * i + 2];
        CHECK(luma > before - 1); // codes are rounded
        before = std::max(before, luma);
    }
    Image special(3, 1, 1);
    special.values = {std::numeric_limits<float>::infinity(), -1.0f, 2.0f};
    const std::vector<std::uint8_t> green_black_white = heat_colors(special);
    CHECK(std::vector<std::uint8_t>(green_black_white.begin(), green_black_white.begin() + 6)
          == std::vector<std::uint8_t>{0, 255, 0, 0, 0, 0});
    CHECK(std::equal(codes.end() - 3, codes.end(), green_black_white.end() - 3));
}
