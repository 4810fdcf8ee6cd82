#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr int side = 1024;
constexpr double samples = double(side) * side;
constexpr float infinity = std::numeric_limits<float>::infinity();

enum Level { classic, low, medium, high, boolean };
std::string_view word_of(Level level) {
    constexpr std::string_view words[] = {"classic", "low", "medium", "high", "reference"};
    return words[level];
}
constexpr Level all_levels[] = {classic, low, medium, high, boolean};
constexpr Level film_levels[] = {medium, high, boolean}; // whose grains have a size

/// Size of grains in heights for so many pixels of a patch.
double pixels(double size) {
    return size / side;
}

/// White grain of one pixel: at `low` every pixel is its own.
const Values white = {{"quality", low}, {"amount", 0.1}, {"size", pixels(1)}, {"color", 1}};
const Values clumped = {{"amount", 0.1}, {"size", pixels(3)}, {"color", 1}};

Values at(Level level, Values values) {
    values["quality"] = level;
    return values;
}

Input patch(double u, std::uint32_t frame = 0, std::uint32_t seed = 0) {
    const float value = static_cast<float>(u);
    return {.color = constant(side, side, {value, value, value}), .frame = frame, .seed = seed};
}

/// How many independent numbers the mean of a patch of clumps is worth, at least. A corner of the lattice
/// owns an area of sqrt(3)/2 size^2, and inside it the three weights divided by their root sum of squares sum
/// to at most sqrt(3).
double independent_samples(double size, double count = samples) {
    return size <= 1 ? count : count / (3 * std::sqrt(0.75) * size * size);
}

struct Statistics {
    double mean = 0, variance = 0;
};

Statistics statistics(const Image& image, int channel) {
    Statistics result;
    const auto count = static_cast<double>(image.pixel_count());
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        result.mean += image.values[image.channels * i + channel] / count;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        result.variance += std::pow(image.values[image.channels * i + channel] - result.mean, 2) / count;
    return result;
}

/// Correlation of one picture's channel with another's, moved by (dx, dy) and wrapped round.
double correlation(const Image& a, int channel_a, const Image& b, int channel_b, int dx = 0, int dy = 0) {
    const Statistics of_a = statistics(a, channel_a), of_b = statistics(b, channel_b);
    double sum = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            sum += (a.at(x, y, channel_a) - of_a.mean)
                   * (b.at((x + dx) % side, (y + dy) % side, channel_b) - of_b.mean);
        }
    }
    return sum / samples / std::sqrt(of_a.variance * of_b.variance);
}

float least_of(const Image& image, int channel) {
    float least = infinity;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        least = std::min(least, image.values[4 * i + static_cast<std::size_t>(channel)]);
    return least;
}

float most_of(const Image& image, int channel) {
    float most = -infinity;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        most = std::max(most, image.values[4 * i + static_cast<std::size_t>(channel)]);
    return most;
}

/// Covariance of two pixels so far apart, in one layer of film with grains of that many pixels. Of points it is
/// C(h) = (1 - u)^2 (e^(lambda overlap) - 1) (Newson, Delon, Galerne 2017); of pixels the mean of that over the
/// differences of places in two unit squares, whose density is a tent.
double film_covariance(double u, double size, int lag) {
    const double diameter = 1.75 * size, radius = diameter / 2;
    const double density = -std::log1p(-u) / (std::acos(-1.0) * radius * radius);
    constexpr int steps = 100;
    double sum = 0;
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
            const double x = 2 * (i + 0.5) / steps - 1, y = 2 * (j + 0.5) / steps - 1;
            const double h = std::min(std::hypot(lag + x, y), diameter);
            const double overlap = 2 * radius * radius * std::acos(h / diameter)
                                   - h / 2 * std::sqrt(diameter * diameter - h * h);
            sum += (1 - std::abs(x)) * (1 - std::abs(y)) * std::expm1(density * overlap);
        }
    }
    return std::pow(1 - u, 2) * sum * 4 / (steps * steps);
}

} // namespace

TEST_CASE("every level is its float64 reference") {
    const std::pair<int, int> sizes[] = {{1, 1}, {40, 1}, {1, 500}, {97, 61}, {120, 500}};
    for (const Level level : {low, medium, high}) {
        for (const auto& [width, height] : sizes) {
            for (double size : {0.4, 1.1, 3.0, 8.0}) {
                const Values values =
                    at(level,
                       {{"amount", 0.2}, {"size", std::clamp(size / height, 0.0002, 0.02)}, {"seed", 77}});
                for (std::uint32_t frame : {0u, 100'000'000u, 0xffffffffu}) {
                    const Input input{.color = noise(width, height, -0.2f, 1.2f), .frame = frame, .seed = 7};
                    const Worst worst = worst_difference(run_effect("grain", input, values),
                                                         reference(reference_input("grain", input, values)));
                    // Lattice coordinates up to 1000 are rounded to 6e-5, the field changes by at most 8 per unit of
                    // them, and the standard deviation is at most 0.5 * 0.2.
                    INFO(width << "x" << height << ", grains of " << size << " pixels, frame " << frame
                               << ", level " << level);
                    CHECK(worst.absolute <= 5e-5);
                }
            }
        }
    }
}

TEST_CASE("discs are those of the float64 reference but for pixels on an edge") {
    for (double size : {0.4, 1.1, 8.0}) {
        const Values values = at(boolean, {{"amount", 0.2}, {"size", size / 400}});
        const Input input{.color = noise(40, 400, -0.2f, 1.2f), .frame = 1000, .seed = 7};
        const Image result = run_effect("grain", input, values);
        const Image64 expected = reference(reference_input("grain", input, values));
        int differing = 0;
        double worst = 0;
        for (int y = 0; y < 400; ++y) {
            for (int x = 0; x < 40; ++x) {
                double difference = 0;
                for (int c = 0; c < 3; ++c)
                    difference = std::max(difference, std::abs(result.at(x, y, c) - expected.at(x, y, c)));
                differing += difference > 5e-5;
                worst = std::max(worst, difference);
            }
        }
        CAPTURE(size);
        // A place rounded by 3e-5 lies on another side of one of some 300 discs' edges, each 3 long in cells that
        // hold about one; a number of discs may also change by one where the sum of the distribution is rounded.
        CHECK(differing <= 0.03 * 40 * 400);
        // One layer of 32, at worst where its weight is greatest and mixed into all channels.
        CHECK(worst <= 0.2 * 2 / std::sqrt(32.0) * 2);
    }
}

TEST_CASE("amount 0 changes no bit") {
    Image color = noise(33, 17, -5, 60);
    color.at(0, 0, 0) = -0.0f;
    color.at(1, 0, 1) = infinity;
    const std::uint32_t payload = 0x7fc12345u;
    std::memcpy(&color.at(2, 0, 2), &payload, sizeof(payload));
    for (const Level level : all_levels) {
        const Values values = at(level, {{"amount", 0}});
        CHECK(same_bits(run_effect("grain", {.color = color}, values), color));
        CHECK(plan_effect("grain", {.color = color}, values).effects.at(0).moment == Moment::configuration);
    }
}

TEST_CASE("the mean stays and the variance is amount^2 u (1 - u)") {
    // FidelityFX's grain has mean -0.098 amount: it darkens.
    const std::vector<Values> cases = {at(low, white),
                                       at(medium, clumped),
                                       at(medium, {{"amount", 0.1}, {"size", pixels(1.05)}, {"color", 0}}),
                                       at(high, white),
                                       at(high, clumped),
                                       at(boolean, clumped)};
    for (const Values& values : cases) {
        const double size = values.at("size").number * side;
        const std::string level = values.at("quality").word;
        for (double u : {0.1, 0.18, 0.9}) {
            if (level == word_of(boolean) && u != 0.18) continue; // slow
            const Image image = run_effect("grain", patch(u), values);
            const double expected = 0.01 * u * (1 - u);
            for (int c = 0; c < 3; ++c) {
                const Statistics found = statistics(image, c);
                INFO("u " << u << ", grains of " << size << " pixels, channel " << c << ", level " << level);
                // The constant input is a float.
                CHECK(std::abs(found.mean - double(float(u)))
                      <= 5 * std::sqrt(expected / independent_samples(size)));
                // Of discs 5 pixels large a patch holds too few to know their variance to 2 %.
                CHECK(found.variance == Approx(expected).epsilon(level == word_of(boolean) ? 0.05 : 0.02));
            }
        }
    }
}

TEST_CASE("discs correlate as pixels of the Boolean model do") {
    const double u = 0.25;
    const Image image =
        run_effect("grain", patch(u), at(boolean, {{"amount", 0.03}, {"size", pixels(4)}, {"color", 1}}));
    for (int lag : {1, 2, 3, 4, 6, 8}) {
        CAPTURE(lag);
        CHECK(correlation(image, 0, image, 0, lag, 0)
              == Approx(film_covariance(u, 4, lag) / film_covariance(u, 4, 0))
                     .margin(5 / std::sqrt(independent_samples(4))));
    }
}

TEST_CASE("discs keep the mean near black and white, beside channels of any light") {
    constexpr double size = 1, layers = 32; // of a grain [pixels]; at most
    constexpr int edge = 512;               // of a patch: the reference is slow
    const std::array<double, 3> lights[] = {
        {0.0005, 0.002, 0.005}, {0.998, 0.5, 0.0005}, {0.0001, 0.00003, 0.9995}};
    for (double amount : {0.03, 0.1, 0.4}) {
        for (double color : {0.3, 1.0}) {
            for (const auto& light : lights) {
                const Input input{.color =
                                      constant(edge, edge,
                                               {static_cast<float>(light[0]), static_cast<float>(light[1]),
                                                static_cast<float>(light[2])})};
                const Image image = run_effect(
                    "grain", input,
                    {{"quality", boolean}, {"amount", amount}, {"size", size / edge}, {"color", color}});
                for (int c = 0; c < 3; ++c) {
                    const double u = light[static_cast<std::size_t>(c)];
                    const Statistics found = statistics(image, c);
                    INFO("amount " << amount << ", color " << color << ", channel " << c << ", u " << u
                                   << ": mean " << 100 * (found.mean / u - 1) << " % off, variance "
                                   << found.variance / (amount * amount * u * (1 - u))
                                   << " of amount^2 u (1 - u)");
                    // Five standard errors, and the Poisson distribution in steps of 2^-24, of which u of 3e-5 has 500.
                    CHECK(std::abs(found.mean - u)
                          <= 5 * std::sqrt(found.variance / independent_samples(size, edge * edge))
                                 + 2e-3 * std::min(u, 1 - u));
                    CHECK(least_of(image, c) >= 0);
                    CHECK(most_of(image, c) <= 1);
                    // Not more than the layers have by themselves: 32, or fewer for a large amount. Near white two
                    // thirds of that, since discs that cut one pixel cut it independently. Below 1 / 8192 grains get
                    // dimmer instead of fewer. So many discs, each of 2.4 pixels, are in the patch at least.
                    const double discs = 2 * std::min(u, 1 - u) * edge * edge / 2.4;
                    const double law = amount * amount * u * (1 - u),
                                 own = film_covariance(u, size, 0) / layers;
                    CHECK(found.variance <= (1 + 5 / std::sqrt(discs)) * law);
                    if (u < 1 / 8192.0 || u > 0.999) continue;
                    CHECK(found.variance
                          >= (u > 0.9 ? 0.6 : 1) * (1 - 5 / std::sqrt(discs)) * std::min(law, own));
                }
            }
        }
    }
}

TEST_CASE("channels of discs correlate by 1 - color where their light is the same") {
    for (double amount : {0.05, 0.6}) {
        for (double color : {0.0, 0.02, 0.3, 0.9, 1.0}) {
            const Image image =
                run_effect("grain", patch(0.3),
                           at(boolean, {{"amount", amount}, {"size", pixels(1)}, {"color", color}}));
            CAPTURE(amount, color);
            CHECK(correlation(image, 0, image, 2)
                  == Approx(1 - color).margin(5 / std::sqrt(independent_samples(1)) + 1e-6));
        }
    }
}

TEST_CASE("levels agree on the size of grains") {
    const Values values = {{"amount", 0.05}, {"size", pixels(4)}, {"color", 1}};
    std::vector<double> correlations;
    for (const Level level : film_levels) {
        const Image image = run_effect("grain", patch(0.5), at(level, values));
        correlations.push_back(correlation(image, 0, image, 0, 2, 0)); // near half its height
    }
    // Shapes differ: a disc's correlation falls linearly, the smooth kernels' from a flat top.
    const double film = film_covariance(0.5, 4, 2) / film_covariance(0.5, 4, 0);
    CHECK(correlations[0] == Approx(film).margin(0.08));
    CHECK(correlations[1] == Approx(film).margin(0.05));
    CHECK(correlations[2] == Approx(film).margin(5 / std::sqrt(independent_samples(4))));
}

TEST_CASE("high is nearly Gaussian") {
    for (double size : {1.0, 2.0}) {
        const Image image = run_effect("grain", patch(0.5),
                                       at(high, {{"amount", 0.05}, {"size", pixels(size)}, {"color", 1}}));
        const Statistics of = statistics(image, 0);
        double fourth = 0;
        for (std::size_t i = 0; i < image.pixel_count(); ++i)
            fourth += std::pow(image.values[4 * i] - of.mean, 4) / samples;
        // Of n equal uniform numbers 3 - 1.2 / n: at least 4 points weigh, and medium's 3 would make 2.6 at most.
        CHECK(fourth / (of.variance * of.variance) > (size == 1 ? 2.7 : 2.76));
        CHECK(fourth / (of.variance * of.variance) < 3);
    }
}

TEST_CASE("low is white whatever the size") {
    const Image image = run_effect("grain", patch(0.5), at(low, clumped));
    CHECK(std::abs(correlation(image, 0, image, 0, 1, 0)) <= 5 / std::sqrt(samples));
    CHECK(std::abs(correlation(image, 0, image, 0, 0, 1)) <= 5 / std::sqrt(samples));
}

TEST_CASE("the clock does not matter, but to classic") {
    for (const Level level : all_levels) {
        Input now{.color = noise(64, 64, 0, 1)}, later = now;
        later.time = 7 * 24 * 3600;
        CHECK(same_bits(run_effect("grain", now, at(level, clumped)),
                        run_effect("grain", later, at(level, clumped)))
              == (level != classic));
    }
}

TEST_CASE("classic is noise, and after a week it is blocks") {
    Input input = patch(0.5);
    const Values values = {{"quality", classic}, {"amount", 0.1}};
    const Image fresh = run_effect("grain", input, values);
    const Statistics of = statistics(fresh, 0);
    CHECK(of.mean == Approx(0.5).margin(0.001));
    CHECK(of.variance == Approx(0.0025).epsilon(0.05));
    CHECK(std::abs(correlation(fresh, 0, fresh, 0, 1, 0)) < 0.05);
    input.time = 7 * 24 * 3600;
    const Image old = run_effect("grain", input, values);
    CHECK(correlation(old, 0, old, 0, 1, 0) > 0.9);
    // Sharp parts have none.
    input = {.color = constant(64, 64, {0.5f, 0.5f, 0.5f}), .camera = Camera::perspective(45, 0.1)};
    input.camera.focus_distance = 4;
    input.attachments["depth"] = constant(64, 64, {static_cast<float>(input.camera.depth_at(4))});
    const Worst worst = worst_difference(run_effect("grain", input, values), convert<double>(input.color));
    CHECK(worst.absolute < 1e-6);
}

TEST_CASE("two films in one chain are independent if their seeds differ") {
    const auto variance = [](int seed) {
        const std::string film = "grain: {amount: 0.1, size: 0.0009765625, seed: ";
        return statistics(run_chain("effects: [{" + film + "0}}, {" + film + std::to_string(seed) + "}}]",
                                    patch(0.5)),
                          0)
            .variance;
    };
    CHECK(variance(0) == Approx(4 * 0.0025).epsilon(0.03)); // the same twice
    for (int seed : {1, 2, 65535})
        CHECK(variance(seed) == Approx(2 * 0.0025).epsilon(0.03));
}

TEST_CASE("near black and white the tails are cut, the mean stays") {
    for (double u : {1e-4, 1e-3, 0.01, 0.99, 0.999}) {
        const Image image = run_effect("grain", patch(u), white);
        const Statistics found = statistics(image, 0);
        CAPTURE(u);
        CHECK(std::abs(found.mean - double(float(u))) <= 5 * std::sqrt(found.variance / samples));
        CHECK(found.variance <= 0.01 * u * (1 - u) * 1.02);
        CHECK(found.variance > 0);
    }
}

TEST_CASE("black, white and what lies outside pass as they are; the rest stays within 0..1") {
    for (float u : {0.0f, 1.0f, -0.25f, 1.5f, 65504.0f}) {
        const Input input{.color = constant(64, 64, {u, u, u})};
        for (const Level level : {low, medium, high, boolean})
            CHECK(same_bits(run_effect("grain", input, at(level, {{"amount", 1}, {"size", 0.02}})),
                            input.color));
    }
    for (double size : {0.0002, 0.02}) {
        const Image image =
            run_effect("grain", {.color = noise(side, side, 0, 1)}, {{"amount", 1}, {"size", size}});
        bool within = true;
        for (float value : image.values)
            within = within && value >= 0 && value <= 1;
        CHECK(within);
    }
}

TEST_CASE("no pixel knows another: neighbours, lags, tile periods") {
    const Image image = run_effect("grain", patch(0.5), white);
    for (int lag : {1, 2, 3, 4, 5, 6, 7, 8, 16, 32, 64, 128, 256, 512}) {
        CAPTURE(lag);
        CHECK(std::abs(correlation(image, 0, image, 0, lag, 0)) <= 5 / std::sqrt(samples));
        CHECK(std::abs(correlation(image, 1, image, 1, 0, lag)) <= 5 / std::sqrt(samples));
        CHECK(std::abs(correlation(image, 2, image, 2, lag, lag)) <= 5 / std::sqrt(samples));
    }
}

TEST_CASE("clumps are as large as asked, alike in all directions, and end") {
    const auto level = static_cast<Level>(GENERATE(2, 3, 4));
    CAPTURE(level);
    const Image image = run_effect("grain", patch(0.5), at(level, clumped));
    const double bound = 5 / std::sqrt(independent_samples(3));
    const double right = correlation(image, 0, image, 0, 2, 0), up = correlation(image, 0, image, 0, 0, 2);
    CHECK(correlation(image, 0, image, 0, 1, 0) > 0.6);
    CHECK(right > 0.1);
    CHECK(std::abs(right - up) <= bound);
    // Two pixels share a corner of the lattice only within twice a triangle's height: 2 * 0.87 * 3 = 5.2
    // pixels; of high's lattice within 4 * 0.45 * 3 = 5.4; a disc only within 1.75 * 3 = 5.3.
    for (int lag : {6, 7, 8, 16, 32, 64, 128, 256, 500}) {
        CAPTURE(lag);
        CHECK(std::abs(correlation(image, 0, image, 0, lag, 0)) <= bound);
        CHECK(std::abs(correlation(image, 0, image, 0, 0, lag)) <= bound);
    }
}

TEST_CASE("the look does not change with resolution") {
    // Grains of 2 pixels here are grains of 4 at twice the height: the same correlation at twice the lag.
    const Image coarse = run_effect("grain", patch(0.5), {{"size", pixels(2)}, {"color", 1}});
    const Image fine = run_effect("grain", patch(0.5), {{"size", pixels(4)}, {"color", 1}});
    for (int lag : {1, 2, 3}) {
        CHECK(correlation(coarse, 0, coarse, 0, lag, 0)
              == Approx(correlation(fine, 0, fine, 0, 2 * lag, 0))
                     .margin(5 / std::sqrt(independent_samples(4))));
    }
    // Pixels larger than grains: deviation times size is constant (Selwyn).
    const double half = statistics(run_effect("grain", patch(0.5), {{"size", pixels(0.5)}}), 0).variance;
    const double quarter = statistics(run_effect("grain", patch(0.5), {{"size", pixels(0.25)}}), 0).variance;
    CHECK(half / quarter == Approx(4).epsilon(0.02));
}

TEST_CASE("frames and seeds are independent, also after weeks; the same frame has the same bits") {
    for (const Values& values : {at(low, white), at(medium, clumped), at(high, clumped)}) {
        const double bound = 5 / std::sqrt(independent_samples(values.at("size").number * side));
        for (std::uint32_t frame : {0u, 100'000'000u, 0x80000000u}) {
            const Image now = run_effect("grain", patch(0.5, frame), values);
            CAPTURE(frame);
            CHECK(same_bits(now, run_effect("grain", patch(0.5, frame), values)));
            CHECK(std::abs(correlation(now, 0, run_effect("grain", patch(0.5, frame + 1), values), 0))
                  <= bound);
            CHECK(std::abs(correlation(now, 0, run_effect("grain", patch(0.5, frame, 1), values), 0))
                  <= bound);
            CHECK(statistics(now, 0).variance == Approx(0.0025).epsilon(0.02));
        }
    }
}

TEST_CASE("channels correlate by 1 - color") {
    for (double color : {0.0, 0.3, 1.0}) {
        const Image image = run_effect("grain", patch(0.5), {{"size", pixels(1)}, {"color", color}});
        for (int c = 0; c < 3; ++c) {
            // Noise of the estimate, or float's rounding of the picture where all channels are equal.
            CHECK(correlation(image, c, image, (c + 1) % 3)
                  == Approx(1 - color).margin(5 / std::sqrt(samples)));
        }
    }
}

TEST_CASE("hostile pixels stay where they are") {
    Image color = constant(33, 210, {0.5f, 1e-40f, 65504});
    color.at(16, 16, 0) = infinity;
    color.at(5, 5, 0) = -infinity;
    color.at(20, 20, 0) = std::numeric_limits<float>::quiet_NaN();
    for (const Level level : all_levels) {
        for (double size : {0.0002, 0.02}) { // without and with clumps
            const Image result =
                run_effect("grain", {.color = color}, at(level, {{"amount", 1}, {"size", size}}));
            int non_finite = 0;
            for (float value : result.values)
                non_finite += !std::isfinite(value);
            CHECK(non_finite == 3);
        }
    }
}
