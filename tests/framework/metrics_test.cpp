#include <catch2/catch.hpp>

#include <image/metrics.hpp>
#include <postfx/error.hpp>

#include <bit>
#include <cmath>
#include <limits>

using namespace postfx;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Reproducible values in [0, 1).
Image noise(int width, int height, int channels, std::uint32_t state = 1) {
    Image image(width, height, channels);
    for (float& value : image.values) {
        state = state * 1664525u + 1013904223u;
        value = static_cast<float>(state >> 8) / 16777216.0f;
    }
    return image;
}

/// Equation 13 of Wang et al. 2004 with the plain two-dimensional window, one window at a time.
double plain_ssim(const Image& a, const Image& b) {
    constexpr int taps = 11;
    double sum = 0;
    int windows = 0;
    for (int y = 0; y + taps <= a.height; ++y)
        for (int x = 0; x + taps <= a.width; ++x, ++windows) {
            double weight_sum = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
            const auto each = [&](auto visit) {
                for (int j = 0; j < taps; ++j)
                    for (int i = 0; i < taps; ++i)
                        visit(std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / 4.5),
                              double(a.at(x + i, y + j, 0)), double(b.at(x + i, y + j, 0)));
            };
            each([&](double w, double pa, double pb) { weight_sum += w, ma += w * pa, mb += w * pb; });
            ma /= weight_sum, mb /= weight_sum;
            each([&](double w, double pa, double pb) {
                va += w / weight_sum * (pa - ma) * (pa - ma);
                vb += w / weight_sum * (pb - mb) * (pb - mb);
                cov += w / weight_sum * (pa - ma) * (pb - mb);
            });
            sum += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
        }
    return sum / windows;
}

} // namespace

TEST_CASE("A picture equals itself") {
    Image image = noise(GENERATE(1, 5, 40), GENERATE(1, 13), GENERATE(1, 2, 3, 4));
    image.values[0] = GENERATE(0.5f, -0.0f, 3e38f, std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity());
    const Difference none = compare(image, image);
    CHECK(none.max_abs == 0);
    CHECK(none.rmse == 0);
    CHECK(none.psnr == infinity);
    CHECK(none.ssim == 1);
    CHECK(none.differing == 0);
    CHECK(none.non_finite == 0);
}

TEST_CASE("Known differences") {
    // One of 8 values is off by 0.5: rmse = 0.5 / sqrt(8), psnr = 20 log10(2 sqrt(8)) = 15.0515 dB
    const Image a(4, 2, 1, 0.25f);
    Image b = a;
    b.at(2, 1, 0) = 0.75f;
    const Difference one = compare(a, b);
    CHECK(one.max_abs == 0.5);
    CHECK(one.rmse == Approx(0.5 / std::sqrt(8.0)).epsilon(1e-15));
    CHECK(one.psnr == Approx(15.0514997831991).epsilon(1e-13));
    CHECK(compare(a, b, 10.0).psnr == Approx(35.0514997831991).epsilon(1e-13));
    CHECK(one.differing == 1);
    CHECK((one.worst_x == 2 && one.worst_y == 1));
}

TEST_CASE("Structural similarity is the published formula") {
    const Image a = noise(23, 17, 1, 1), b = noise(23, 17, 1, 2);
    // Same formula summed in another order, in double: rounding only.
    CHECK(compare(a, b).ssim == Approx(plain_ssim(a, b)).epsilon(1e-12));
    CHECK(compare(a, b).ssim == compare(b, a).ssim);
    CHECK(compare(a, b).ssim < 0.2);
    // Two constants differ in luminance alone: (2ab + c1) / (a^2 + b^2 + c1), whatever the window
    const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4);
    for (const int side : {1, 4, 11, 30})
        CHECK(compare(Image(side, 2, 3, 0.25f), Image(side, 2, 3, 0.75f)).ssim
              == Approx(expected).epsilon(1e-12));
    Image shifted = a;
    for (float& value : shifted.values)
        value = 1 - value;
    CHECK(compare(a, shifted).ssim < 0);
    CHECK(std::isfinite(compare(Image(20, 20, 1, 3e38f), Image(20, 20, 1, -3e38f)).ssim));
}

TEST_CASE("Bits count, values decide") {
    const float nan_1 = std::bit_cast<float>(0x7fc00001u), nan_2 = std::bit_cast<float>(0x7fc00002u);
    for (const auto& [x, y] : {std::pair{0.0f, -0.0f}, std::pair{nan_1, nan_2}}) {
        const Difference bits = compare(Image(3, 3, 3, x), Image(3, 3, 3, y));
        CHECK(bits.differing == 9);
        CHECK(bits.rmse == 0);
        CHECK(bits.psnr == infinity);
        CHECK(bits.ssim == 1);
        CHECK(bits.non_finite == 0);
    }
}

TEST_CASE("A NaN or infinity that only one picture has is the worst there is") {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto [x, y] =
        GENERATE_COPY(std::pair{nan, 1.0f}, std::pair{1.0f, inf}, std::pair{inf, -inf}, std::pair{nan, inf});
    Image a(4, 4, 3, 0.5f), b = a;
    b.at(0, 0, 0) = 0.75f;
    a.at(1, 2, 1) = x;
    b.at(1, 2, 1) = y;
    const Difference difference = compare(a, b);
    CHECK(difference.non_finite == 1);
    CHECK(difference.differing == 2);
    CHECK(difference.max_abs == 0.25);
    CHECK(difference.rmse == infinity);
    CHECK(difference.psnr == -infinity);
    CHECK(difference.ssim == 0);
    CHECK((difference.worst_x == 1 && difference.worst_y == 2));
}

TEST_CASE("What can't be compared") {
    CHECK_THROWS_WITH(compare(Image(2, 2, 3), Image(3, 2, 3)),
                      Catch::Contains("2 x 2") && Catch::Contains("3 x 2"));
    CHECK_THROWS_AS(compare(Image(2, 2, 3), Image(2, 2, 4)), Error);
    CHECK_THROWS_AS(compare(Image(), Image()), Error);
    CHECK_THROWS_AS(compare(Image(1, 1, 1), Image(1, 1, 1), 0.0), Error);
}

TEST_CASE("Relative errors of light") {
    // One of 2 pixels: r = 0.99, x = 1.19 in red; the scale of the first is 0.99 + 0.01 = 1.
    Image64 reference(2, 1, 3, 0.99), picture = reference;
    picture.at(0, 0, 0) = 1.19;
    const RelativeError error = relative_error(picture, reference);
    CHECK(error.rel_mse == Approx(0.04 / 6).epsilon(1e-12));
    CHECK(error.relative_rmse == Approx(0.2 / (0.99 * std::sqrt(6.0))).epsilon(1e-12));
    CHECK(error.non_finite == 0);
    CHECK(relative_error(reference, reference).rel_mse == 0);
    // Light in other units: relative_rmse stays, rel_mse nearly does where 0.01 is little.
    for (auto* image : {&picture, &reference})
        for (double& value : image->values)
            value *= 1024;
    CHECK(relative_error(picture, reference).relative_rmse == Approx(error.relative_rmse).epsilon(1e-12));
    // In the dark 0.01 keeps it finite, for negative light too.
    CHECK(relative_error(Image64(1, 1, 1, 0.01), Image64(1, 1, 1)).rel_mse == Approx(1));
    CHECK(relative_error(Image64(1, 1, 1, 0.0), Image64(1, 1, 1, -0.01)).rel_mse == Approx(0.25));
    CHECK(relative_error(Image64(1, 1, 1, 0.01), Image64(1, 1, 1)).relative_rmse == infinity);
    CHECK(relative_error(Image64(1, 1, 1), Image64(1, 1, 1)).relative_rmse == 0);
}

TEST_CASE("Relative errors leave out alpha and nothing else") {
    Image64 reference(3, 3, 4, 0.5), picture = reference;
    picture.at(1, 1, 3) = 0.0;
    CHECK(relative_error(picture, reference).rel_mse == 0);
    picture.at(1, 1, 3) = std::nan("");
    CHECK(relative_error(picture, reference).non_finite == 0);
    picture.at(1, 1, 2) = reference.at(1, 1, 2) = infinity; // in both: still no error that could be told
    picture.at(2, 1, 0) = std::nan("");
    const RelativeError error = relative_error(picture, reference);
    CHECK(error.non_finite == 2);
    CHECK(error.rel_mse == infinity);
    CHECK(error.relative_rmse == infinity);
    CHECK_THROWS_AS(relative_error(Image64(2, 2, 3), Image64(2, 2, 4)), Error);
}
