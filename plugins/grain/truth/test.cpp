// Film's closed forms against each other, and its realisation against them.
#include <catch2/catch.hpp>

#include "film.hpp"

#include <truth_of.hpp>

#include <array>
#include <cmath>
#include <numbers>

using namespace postfx::host;
using postfx::Image64;

namespace {

using Values = postfx::testing::Numbers;

TruthResult grained(const Image64& light, const Values& values, int samples, std::uint32_t frame = 0) {
    return postfx::testing::truth_of("grain", "layer", light, values, samples, frame);
}

/// Integral of the covariance over the plane: shares of discs, ring by ring.
double covariance_integral(const FilmStatistics& film, double u, double diameter) {
    constexpr int rings = 20000;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double r = diameter * (i + 0.5) / rings;
        sum += 2 * std::numbers::pi * r * film.point_covariance(u, r) * diameter / rings;
    }
    return sum;
}

double correlation(const Image64& a, int channel_a, const Image64& b, int channel_b, double mean,
                   int across = 0) {
    double product = 0, square_a = 0, square_b = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x + across < a.width; ++x) {
            const double p = a.at(x, y, channel_a) - mean, q = b.at(x + across, y, channel_b) - mean;
            product += p * q;
            square_a += p * p;
            square_b += q * q;
        }
    }
    return product / std::sqrt(square_a * square_b);
}

} // namespace

TEST_CASE("film's covariance is u (1 - u) at a point and ends at a disc's diameter") {
    for (const double u : {1e-6, 0.2, 0.5, 0.97}) {
        const FilmStatistics film(3.5);
        CHECK(film.point_covariance(u, 0) == Approx(u * (1 - u)).epsilon(1e-9));
        CHECK(film.point_covariance(u, 3.49999) == Approx(0).margin(1e-6 * u));
        CHECK(film.point_covariance(u, 4) == 0);
        // Discs of 1.75 times the grain's size: half at 0.58 of it in mid-tones.
        if (u == 0.5) CHECK(film.point_covariance(u, 2 * 0.58) == Approx(0.125).margin(0.002));
    }
}

TEST_CASE("pixels of film: their covariances sum to the integral, whatever the size") {
    for (const double diameter : {0.35, 1.0, 2.8, 6.0}) {
        for (const double u : {0.05, 0.5, 0.9}) {
            const FilmStatistics film(diameter);
            double sum = 0;
            for (int j = -film.reach(); j <= film.reach(); ++j) {
                for (int i = -film.reach(); i <= film.reach(); ++i)
                    sum += film.pixel_covariance(u, std::abs(i), std::abs(j));
            }
            INFO("diameter " << diameter << ", light " << u);
            // 24 nodes over covariances with a cusp at 0 and an end within the pixel.
            CHECK(sum == Approx(covariance_integral(film, u, diameter)).epsilon(2e-3));
            CHECK(film.pixel_covariance(u, film.reach(), 0) == Approx(0).margin(1e-15));
        }
    }
}

TEST_CASE("a pixel's variance is the mean covariance of its places") {
    for (const double diameter : {0.7, 1.2, 2.8}) {
        const FilmStatistics film(diameter);
        constexpr int steps = 400; // of the difference of two places, whose density is a tent
        double sum = 0;
        for (int j = 0; j < steps; ++j) {
            for (int i = 0; i < steps; ++i) {
                const double x = (i + 0.5) / steps, y = (j + 0.5) / steps;
                sum += 4 * (1 - x) * (1 - y) * film.point_covariance(0.4, std::hypot(x, y)) / steps / steps;
            }
        }
        CHECK(film.pixel_variance(0.4) == Approx(sum).epsilon(1e-4));
    }
    CHECK(FilmStatistics(1e4).pixel_variance(0.3)
          == Approx(0.21).epsilon(1e-3)); // one disc covers all or nothing
}

TEST_CASE("discs cover what they should, together as they should") {
    constexpr int places = 200000;
    constexpr double diameter = 2;
    const FilmStatistics statistics(diameter);
    const Film film(diameter, 7);
    for (const double u : {0.1, 0.5, 0.95}) {
        const double bareness = Film::bareness(u);
        for (const double distance : {0.5, 1.2, 2.5}) {
            int covered = 0, both = 0;
            for (int i = 0; i < places; ++i) { // a layer each: independent
                const double x = 10.3 + 0.7 * (i % 13), y = 5.1;
                const bool here = film.is_covered(i, x, y, bareness),
                           there = film.is_covered(i, x + 0.6 * distance, y + 0.8 * distance, bareness);
                covered += here;
                both += here && there;
            }
            const double mean = covered / double(places), together = both / double(places);
            const double expected = u * u + statistics.point_covariance(u, distance);
            INFO("light " << u << ", distance " << distance);
            CHECK(mean == Approx(u).margin(5 * std::sqrt(u * (1 - u) / places)));
            CHECK(together == Approx(expected).margin(5 * std::sqrt(expected * (1 - expected) / places)));
        }
    }
}

TEST_CASE("more light only ever adds discs") {
    const Film film(2, 3);
    int gained = 0;
    for (int i = 0; i < 20000; ++i) {
        const bool dim = film.is_covered(0, 0.37 * i, 4, Film::bareness(0.3));
        const bool bright = film.is_covered(0, 0.37 * i, 4, Film::bareness(0.6));
        REQUIRE((bright || !dim));
        gained += bright && !dim;
    }
    CHECK(gained > 4000); // 30 % of the places, which are correlated
}

TEST_CASE("a grainy picture has film's mean, deviation and covariance") {
    constexpr int size = 128;
    constexpr double grain = 1.6, amount = 0.05, u = 0.4; // grains of 1.6 px
    const Values values = {{"amount", amount}, {"size", grain / size}, {"color", 1}};
    const FilmStatistics film(1.75 * grain);
    double mean = 0, variance = 0;
    std::array<double, 4> found{};
    constexpr int frames = 2;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const Image64 result = grained(Image64(size, size, 3, u), values, 16, frame).picture;
        for (const double value : result.values) {
            mean += value / static_cast<double>(frames * result.values.size());
            variance += std::pow(value - u, 2) / static_cast<double>(frames * result.values.size());
        }
        for (int channel = 0; channel < 3; ++channel) {
            for (int lag = 0; lag < 4; ++lag)
                found[static_cast<std::size_t>(lag)] +=
                    correlation(result, channel, result, channel, u, lag) / (3 * frames);
        }
    }
    // Independent places: 2 x 3 pictures over the area that a covariance takes, 4 px^2: 25 000.
    const double deviation = amount * std::sqrt(u * (1 - u));
    CHECK(mean == Approx(u).margin(5 * deviation / std::sqrt(25000)));
    // 16 places in a pixel leave some 2 % of variance besides; 5 times sqrt(2 / 25000).
    CHECK(variance / (deviation * deviation) == Approx(1).margin(0.045 + 0.02));
    for (int lag = 1; lag < 4; ++lag)
        CHECK(found[static_cast<std::size_t>(lag)]
              == Approx(film.pixel_covariance(u, lag, 0) / film.pixel_variance(u))
                     .margin(5 / std::sqrt(25000)));
}

TEST_CASE("grains below a pixel deviate by Selwyn's law, whatever the light") {
    constexpr int size = 64;
    for (const double u : {0.1, 0.8}) {
        const Values values = {{"amount", 0.05}, {"size", 0.3 / size}};
        const Image64 result = grained(Image64(size, size, 3, u), values, 64).picture;
        double variance = 0;
        for (const double value : result.values)
            variance += std::pow(value - u, 2) / static_cast<double>(result.values.size());
        // 64 places in a pixel of 1 / 0.24 discs: more variance than the whole pixel has, by a quarter of 1 / 64 of
        // a point's, which is 5 times a pixel's.
        CHECK(std::sqrt(variance / (u * (1 - u))) == Approx(0.05 * 0.3).epsilon(0.06));
    }
}

TEST_CASE("channels correlate as color says; frames, seeds and entries do not") {
    const Image64 grey(96, 96, 3, 0.5);
    const Values values = {{"amount", 0.1}, {"size", 1.5 / 96}, {"color", 0.3}};
    const Image64 result = grained(grey, values, 8).picture;
    constexpr double margin = 5 / 48.0; // 96^2 pixels over a covariance's 4: 2304 independent places
    CHECK(correlation(result, 0, result, 1, 0.5) == Approx(0.7).margin(margin));
    CHECK(correlation(result, 0, result, 2, 0.5) == Approx(0.7).margin(margin));
    Values same = values;
    same["color"] = 0;
    const Image64 common = grained(grey, same, 4).picture;
    for (std::size_t i = 0; i < common.values.size(); i += 3)
        REQUIRE(common.values[i] == common.values[i + 2]);
    Values other = values;
    other["seed"] = 1;
    CHECK(std::abs(correlation(result, 0, grained(grey, other, 8).picture, 0, 0.5)) < margin);
    CHECK(std::abs(correlation(result, 0, grained(grey, values, 8, 1).picture, 0, 0.5)) < margin);
}

TEST_CASE("black, white and what is beyond pass, and nothing leaves 0..1") {
    Image64 light(64, 64, 3, 0.002);
    light.at(3, 3, 0) = 0;
    light.at(3, 3, 1) = 1;
    light.at(3, 3, 2) = 4;
    const Image64 result = grained(light, {{"amount", 1}, {"size", 0.02}}, 4).picture;
    CHECK(result.at(3, 3, 0) == 0);
    CHECK(result.at(3, 3, 1) == 1);
    CHECK(result.at(3, 3, 2) == 4);
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        if (light.values[i] < 1) REQUIRE((result.values[i] >= 0 && result.values[i] <= 1));
    }
}

TEST_CASE("a truth's mean stays near black and white, though film's noise is skewed there") {
    constexpr int size = 160;
    for (const double u : {0.002, 0.005, 0.998}) {
        const Values values = {{"amount", 0.1}, {"size", 1.0 / size}, {"color", 0.3}};
        double mean = 0;
        const Image64 result = grained(Image64(size, size, 3, u), values, 16).picture;
        for (const double value : result.values)
            mean += value / static_cast<double>(result.values.size());
        // 5 standard errors: channels have 70 % in common, neighbours a covariance of 3 pixels.
        const double independent = size * size / 3.0;
        CAPTURE(u);
        CHECK(mean == Approx(u).margin(5 * 0.1 * std::sqrt(u * (1 - u) / independent)));
    }
}

TEST_CASE("own error is what more places in the pixels change") {
    const Image64 grey(48, 48, 3, 0.5);
    const Values values = {{"amount", 0.1}, {"size", 0.02}};
    const TruthResult few = grained(grey, values, 16), many = grained(grey, values, 256);
    double sum = 0;
    for (std::size_t i = 0; i < many.picture.values.size(); ++i)
        sum += std::pow(few.picture.values[i] - many.picture.values[i], 2);
    const double error =
        std::sqrt(sum / static_cast<double>(many.picture.values.size())) / many.root_mean_square;
    CHECK(few.own_error == Approx(error).epsilon(0.3)); // all pixels have the same places: little to judge by
    CHECK(many.own_error < few.own_error / 5);          // more than sqrt(32)
}
