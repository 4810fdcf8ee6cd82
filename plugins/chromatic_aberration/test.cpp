#include <testing.hpp>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr double ulp = 0x1p-23; // of 1
constexpr float infinity = std::numeric_limits<float>::infinity();
// Where the ends of the spectrum lie relative to green, as shares of their distance, by Cauchy's 1 /
// wavelength^2.
const double red_end =
    (std::pow(0.612, -2) - std::pow(0.549, -2)) / (std::pow(0.464, -2) - std::pow(0.612, -2));
const double blue_end = red_end + 1;
const double pi = std::acos(-1.0);

enum Level { classic, low, medium, high, ultra, best };
std::string_view word_of(Level level) {
    constexpr std::string_view words[] = {"classic", "low", "medium", "high", "ultra", "reference"};
    return words[level];
}
constexpr Level all_levels[] = {classic, low, medium, high, ultra, best};
constexpr Level spectra[] = {medium, high, ultra, best}; // the levels that integrate over wavelengths

Values with(double strength, Level level) {
    return {{"strength", strength}, {"quality", level}};
}

Image run(const Image& color, double strength, Level level = medium) {
    return run_effect("chromatic_aberration", {.color = color}, with(strength, level));
}

/// The share of the radius by which a sample at `end` of the spectrum is displaced.
double share(const Image& image, double strength, double end) {
    return strength * end * image.height / (0.5 * std::hypot(image.width, image.height));
}

/// The mean of f(magnification) over each channel's kernel, by many wavelengths: the phenomenon itself.
std::array<double, 3> over_spectrum(const Image& image, double strength,
                                    const std::function<double(double)>& f) {
    constexpr int wavelengths = 1024;
    std::array<double, 3> mean{};
    for (int i = 0; i < wavelengths; ++i) {
        const double t = (i + 0.5) / wavelengths;
        const double red = f(1 + t * share(image, strength, red_end)) / wavelengths;
        const double blue = f(1 + t * share(image, strength, blue_end)) / wavelengths;
        mean[0] += 2 * t * red;
        mean[1] += (1 - t) * (red + blue);
        mean[2] += 2 * t * blue;
    }
    return mean;
}

/// f of the offset from the centre in pixels, the same in all channels.
Image painted(int width, int height, const std::function<double(double, double)>& f) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c)
                image.at(x, y, c) = static_cast<float>(f(x + 0.5 - width / 2.0, y + 0.5 - height / 2.0));
        }
    }
    return image;
}

} // namespace

TEST_CASE("every level is its float64 reference") {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 17}, {31, 1}, {97, 61}, {64, 120}};
    for (const Level level : all_levels) {
        // A sampler may round its two weights to 8 fractional bits, half a step each way. Areas are weighed in
        // float32: places of up to 200 pixels are rounded by 1e-5, and their slopes reach 2 per unit of 65.
        const double bound = level < high ? 65 * 2 * (1 / 512.0) : 65 * 2 * 2e-5;
        for (const auto& [width, height] : sizes) {
            for (double strength : {0.003, -0.05}) {
                const Input input{.color = noise(width, height, -5, 60)};
                const Worst worst = worst_difference(
                    run(input.color, strength, level),
                    reference(reference_input("chromatic_aberration", input, with(strength, level))));
                INFO(width << "x" << height << ", strength " << strength << ", level " << level);
                CHECK(worst.absolute <= bound);
            }
        }
    }
}

TEST_CASE("classic goes by the focus where it is known") {
    Input input{.color = noise(97, 61, -5, 60), .camera = Camera::perspective(45, 0.1)};
    input.camera.focus_distance = 4;
    Image depth(97, 61, 1);
    for (int y = 0; y < 61; ++y) {
        for (int x = 0; x < 97; ++x)
            depth.at(x, y, 0) = x < 20 ? 0.0f : static_cast<float>(input.camera.depth_at(1 + 0.1 * x));
    }
    input.attachments["depth"] = depth;
    const Values values = with(0.05, classic);
    const Image result = run_effect("chromatic_aberration", input, values);
    const Worst worst =
        worst_difference(result, reference(reference_input("chromatic_aberration", input, values)));
    CHECK(worst.absolute <= 65 * 2 * (1 / 512.0)); // as above
    // In focus there is no aberration at all, which no lens does: the level's own error.
    bool differs = false;
    for (int y = 0; y < 61; ++y) {
        CHECK(result.at(30, y, 0) == Approx(input.color.at(30, y, 0)).margin(65 / 256.0));
        differs = differs || std::abs(result.at(95, y, 0) - input.color.at(95, y, 0)) > 1;
    }
    CHECK(differs);
}

TEST_CASE("strength 0 changes no bit") {
    Image color = noise(33, 17, -5, 60);
    color.at(0, 0, 0) = -0.0f;
    color.at(1, 0, 1) = infinity;
    const std::uint32_t payload = 0x7fc12345u;
    std::memcpy(&color.at(2, 0, 2), &payload, sizeof(payload));
    CHECK(same_bits(run(color, 0), color));
    CHECK(plan_effect("chromatic_aberration", {.color = color}, {{"strength", 0}}).effects.at(0).moment
          == Moment::configuration);
}

TEST_CASE("a constant stays as it is to the last bit") {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 50}, {50, 1}, {97, 61}}) {
        for (double strength : {0.001, 0.003, 0.05, -0.05}) {
            const Image color = constant(width, height, {0.1f, -7.3f, 65504});
            for (const Level level : all_levels)
                CHECK(same_bits(run(color, strength, level), color));
        }
    }
}

TEST_CASE("a ramp is displaced by each channel's mean, at any resolution") {
    for (int height : {60, 120, 240}) {
        for (double strength : {0.003, 0.04, -0.04}) {
            const int width = 2 * height;
            // 1 over the picture's height, so that the expected change is the displacement in heights.
            const Image color = painted(width, height, [&](double x, double) { return x / height; });
            // A kernel that rises towards its end has its mean at 2/3; green has half of its own on either
            // side, at 1/3.
            const double means[] = {2 / 3.0 * red_end, (red_end + blue_end) / 6, 2 / 3.0 * blue_end};
            const int x = width * 4 / 5; // no sample reaches the border, |share| < 0.05
            const double offset = (x + 0.5) / height - 1;
            for (const Level level : {low, medium, high, ultra, best}) {
                if (level == best && height > 120) continue; // slow, and nothing else than below
                const Image result = run(color, strength, level);
                for (int c : {0, 1, 2}) {
                    if (level == low && c == 1) continue; // green stays where it is
                    const double expected = offset * (1 + share(color, strength, means[c]));
                    CAPTURE(height, strength, c, level);
                    // Half a step of a weight of 8 bits, in pixels; a pixel is 1 / height.
                    CHECK(std::abs(result.at(x, height / 3, c) - expected) <= 1 / 512.0 / height + 8 * ulp);
                }
            }
        }
    }
}

TEST_CASE("red moves outwards, blue inwards, radially") {
    const Image color = impulse(121, 81, 100, 40, 1); // right of the centre (60, 40)
    const Image result = run(color, 0.05);
    double center[3] = {}, mass[3] = {}, beside = 0;
    for (int y = 0; y < 81; ++y) {
        for (int x = 0; x < 121; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double value = result.at(x, y, c);
                mass[c] += value;
                center[c] += value * x;
                beside = std::max(beside, std::abs(y - 40) > 1 ? std::abs(value) : 0.0);
            }
        }
    }
    CHECK(center[0] / mass[0] > 100);
    CHECK(center[2] / mass[2] < 100);
    CHECK(beside == 0);
}

TEST_CASE("levels approach the whole spectrum, the higher the closer") {
    // Waves in all directions that are known everywhere, the shortest 6 pixels long.
    const auto light = [](double x, double y) {
        return std::sin(2 * pi / 11 * x) * std::cos(2 * pi / 17 * y)
               + 0.5 * std::sin(2 * pi / 6 * (0.6 * x + 0.8 * y))
               + 0.5 * std::cos(2 * pi * (x * x + y * y) / 4000);
    };
    const Image color = painted(144, 90, light);
    for (double strength : {0.02, 0.05}) {
        std::map<Level, double> errors; // root mean square
        std::vector<std::array<double, 3>> truth;
        const int border = 8; // beyond which the wave is not stored
        for (int y = border; y < 90 - border; ++y) {
            for (int x = border; x < 144 - border; ++x) {
                truth.push_back(over_spectrum(color, strength, [&](double scale) {
                    return light((x + 0.5 - 72) * scale, (y + 0.5 - 45) * scale);
                }));
            }
        }
        for (const Level level : all_levels) {
            const Image result = run(color, strength, level);
            double squares = 0;
            std::size_t i = 0;
            for (int y = border; y < 90 - border; ++y) {
                for (int x = border; x < 144 - border; ++x, ++i) {
                    for (int c = 0; c < 3; ++c)
                        squares += std::pow(result.at(x, y, c) - truth[i][static_cast<std::size_t>(c)], 2);
                }
            }
            errors[level] = std::sqrt(squares / (3.0 * double(truth.size())));
        }
        fmt::print(
            "strength {}: rms error classic {:.5f}, low {:.5f}, medium {:.5f}, high {:.5f}, ultra {:.5f}, "
            "reference {:.5f}\n",
            strength, errors[classic], errors[low], errors[medium], errors[high], errors[ultra],
            errors[best]);
        CHECK(errors[low] < errors[classic]);
        CHECK(errors[medium] < errors[low]);
        CHECK(errors[high] < errors[medium]);
        CHECK(errors[ultra] < errors[high]);
        CHECK(errors[best] < errors[ultra]);
    }
}

TEST_CASE("an edge lies where the spectrum has its mean") {
    // A soft edge at that many pixels right of the centre; its derivative's centroid is its place.
    for (double place : {40.3, -71.9, 100.0}) {
        for (double strength : {0.003, 0.03, -0.03}) {
            const Image color =
                painted(260, 9, [&](double x, double) { return 0.5 + 0.5 * std::erf((x - place) / 1.2); });
            for (const Level level : spectra) {
                const Image result = run(color, strength, level);
                const auto expected =
                    over_spectrum(color, strength, [&](double scale) { return place / scale; });
                for (int c = 0; c < 3; ++c) {
                    double moment = 0, sum = 0;
                    for (int x = 0; x + 1 < 260; ++x) {
                        const double step = result.at(x + 1, 4, c) - result.at(x, 4, c);
                        moment += step * (x + 1 - 130);
                        sum += step;
                    }
                    CAPTURE(place, strength, level, c);
                    CHECK(std::abs(moment / sum - expected[static_cast<std::size_t>(c)]) <= 0.05);
                }
            }
        }
    }
}

TEST_CASE("each channel keeps its light") {
    const Image color = painted(160, 120, [](double x, double y) {
        return std::exp(-(std::pow(x - 38.2, 2) + std::pow(y - 30.7, 2)) / (2 * 2.5 * 2.5));
    });
    double before = 0;
    for (std::size_t i = 0; i < color.pixel_count(); ++i)
        before += color.values[3 * i];
    for (double strength : {0.003, 0.05}) {
        // Magnified by 1 + d, a picture has (1 + d)^2 times the light.
        const auto expected =
            over_spectrum(color, strength, [](double scale) { return 1 / (scale * scale); });
        for (const Level level : spectra) {
            const Image result = run(color, strength, level);
            for (int c = 0; c < 3; ++c) {
                double after = 0;
                for (std::size_t i = 0; i < result.pixel_count(); ++i)
                    after += result.values[4 * i + static_cast<std::size_t>(c)];
                CAPTURE(strength, level, c);
                // A sampler's weights may have 8 bits: 1 / 512 off. Of what is left, see the next test.
                CHECK(std::abs(after / before / expected[static_cast<std::size_t>(c)] - 1)
                      <= (level == medium ? 1 / 512.0 : 1e-4));
            }
        }
    }
}

TEST_CASE("a single pixel and a line keep their light, wherever they stand") {
    // Closed form: one wavelength's image is 1 + d times as large and, as light per area does not change, has
    // 1 / (1 + d) of a line's light along an axis, the square of that of a point's.
    const int width = 192, height = 120;
    for (double strength : {0.003, 0.01, 0.02, 0.05, -0.05}) {
        const auto across =
            over_spectrum(constant(width, height, {0}), strength, [](double scale) { return 1 / scale; });
        const auto both = over_spectrum(constant(width, height, {0}), strength,
                                        [](double scale) { return 1 / (scale * scale); });
        const double largest = std::abs(share(constant(width, height, {0}), strength, blue_end));
        for (const Level level : spectra) {
            if (level == best && std::abs(strength) > 0.02) continue; // slow, and nothing else than ultra
            // From high on what a pixel's image shows is areas that tile it. What is left is float's rounding of their
            // ends, 2e-6 pixels of light that is 1.5 per pixel at most, and the few samples of the spectrum: linear
            // between 12 of them, 1 / (1 + d)^2 is off by 3/4 (d / 12)^2 = 1e-5. Medium's filter is sampled at
            // distances of 1 + d: it finds up to 1 + d of a pixel that a sample hits; and its weights may have 8 bits.
            const double bound = level == medium ? 2 * largest + 1 / 256.0 : 1e-4;
            Image points(width, height, 3), lines(width, height, 3);
            // So far apart that images do not meet: 4 pixels in the corner, and the filter's 4 on either side.
            for (int y = 12; y < height - 12; y += 16) {
                for (int x = 12 + y % 7; x < width - 12; x += 17) {
                    for (int c = 0; c < 3; ++c)
                        points.at(x, y, c) = 40;
                }
            }
            for (int x = 12; x < width - 12; x += 17) {
                for (int y = 0; y < height; ++y) {
                    for (int c = 0; c < 3; ++c)
                        lines.at(x, y, c) = 40;
                }
            }
            const Image of_points = run(points, strength, level), of_lines = run(lines, strength, level);
            double worst_point = 0, worst_line = 0, least = 0;
            for (int y = 12; y < height - 12; y += 16) {
                for (int x = 12 + y % 7; x < width - 12; x += 17) {
                    for (int c = 0; c < 3; ++c) {
                        double light = 0;
                        for (int j = y - 8; j < y + 8; ++j) {
                            for (int i = x - 8; i < x + 9; ++i)
                                light += of_points.at(i, j, c) / 40;
                        }
                        worst_point =
                            std::max(worst_point, std::abs(light / both[static_cast<std::size_t>(c)] - 1));
                    }
                }
            }
            for (int x = 12; x < width - 12; x += 17) {
                for (int c = 0; c < 3; ++c) {
                    double light = 0;
                    for (int i = x - 8; i < x + 9; ++i)
                        light += of_lines.at(i, 50, c) / 40;
                    worst_line =
                        std::max(worst_line, std::abs(light / across[static_cast<std::size_t>(c)] - 1));
                }
            }
            for (const float value : of_points.values)
                least = std::min(least, static_cast<double>(value));
            INFO("strength " << strength << ", level " << level << ": points " << 100 * worst_point
                             << " % off, lines " << 100 * worst_line << " %, least " << least);
            CHECK(worst_point <= bound);
            CHECK(worst_line <= bound);
            CHECK(least >= 0);
        }
    }
}

TEST_CASE("a mirrored picture has a mirrored result") {
    const Image color = noise(61, 40, 0, 10);
    Image mirrored = color;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 61; ++x) {
            for (int c = 0; c < 3; ++c)
                mirrored.at(x, y, c) = color.at(60 - x, 39 - y, c);
        }
    }
    for (const Level level : all_levels) {
        const Image a = run(color, 0.04, level), b = run(mirrored, 0.04, level);
        double worst = 0;
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 61; ++x) {
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, double(std::abs(a.at(x, y, c) - b.at(60 - x, 39 - y, c))));
            }
        }
        CAPTURE(level);
        // Two weights that may be rounded to 8 fractional bits; places in float32.
        CHECK(worst <= (level < high ? 10 * 2 / 256.0 : 10 * 2 * 2e-5));
    }
}

TEST_CASE("with next to no strength all channels stay in their place") {
    // FidelityFX's lens adds half a pixel to the coordinates of red and green, and none to blue's: with strength 0
    // blue is displaced.
    const Image color = noise(64, 36, 0, 1);
    for (const Level level : all_levels) {
        const Worst worst = worst_difference(run(color, 1e-9, level), convert<double>(color));
        CAPTURE(level);
        CHECK(worst.absolute <= 1 / 256.0); // of a weight of 8 bits
    }
}

TEST_CASE("coordinates are those of 8192 pixels too") {
    // In half precision places beyond 2048 are 2 pixels apart.
    const Image color = painted(8192, 2, [](double x, double) { return 0.5 + x / 8192; });
    for (const Level level : {medium, ultra}) {
        const Image result = run(color, 0.05, level);
        double worst = 0;
        for (int x = 4096; x < 8000; ++x) {
            const double expected =
                0.5 + (x + 0.5 - 4096) / 8192 * (1 + share(color, 0.05, 2 / 3.0 * blue_end));
            worst = std::max(worst, std::abs(result.at(x, 0, 2) - expected));
        }
        CHECK(worst <= 0.1 / 8192); // a tenth of a pixel
    }
}

TEST_CASE("no strength turns the picture inside out, and one that could is refused") {
    for (double aspect : {0.001, 1.0, 1000.0}) {
        const double corner = 0.5 * std::hypot(1.0, aspect);
        CHECK(0.05 * blue_end / corner < 0.1); // of the radius
    }
    CHECK_THROWS_AS(
        plan_effect("chromatic_aberration", {.color = constant(8, 8, {1, 1, 1})}, {{"strength", 0.8}}),
        Error);
}

TEST_CASE("beside a lamp it gets no darker than the surroundings") {
    Image color = constant(121, 81, {0.5f, 0.5f, 0.5f});
    for (int c = 0; c < 3; ++c)
        color.at(100, 40, c) = 500;
    for (const Level level : spectra) {
        float darkest = 1;
        const Image result = run(color, 0.02, level);
        for (int x = 80; x < 121; ++x) {
            for (int c = 0; c < 3; ++c)
                darkest = std::min(darkest, result.at(x, 40, c));
        }
        CAPTURE(level);
        CHECK(darkest >= 0.5f);
    }
}

TEST_CASE("twice the light gives twice the picture to the last bit") {
    const Image color = noise(41, 23, -5, 60);
    for (const Level level : all_levels) {
        const Image once = run(color, 0.03, level);
        for (float factor : {0x1p9f, 0x1p-10f}) {
            CAPTURE(level, factor);
            CHECK(same_bits(run(scaled(color, factor), 0.03, level), scaled(once, factor)));
        }
    }
}

TEST_CASE("what is not finite stays within the displacement, as finite light") {
    const Image clean = noise(121, 81, 0, 1);
    const double strength = 0.05;
    for (float hostile : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
        Image color = clean;
        for (int c = 0; c < 3; ++c)
            color.at(100, 60, c) = hostile;
        for (const Level level : all_levels) {
            const Image expected = run(clean, strength, level), result = run(color, strength, level);
            // 4 pixels in the corner at most, and the filter's.
            const double filter = level >= ultra ? 4.5 : level == high ? 3 : 1.5;
            const double reach = std::abs(share(color, strength, blue_end)) * std::hypot(60, 40) + filter;
            int non_finite = 0, far_changes = 0;
            for (int y = 0; y < 81; ++y) {
                for (int x = 0; x < 121; ++x) {
                    for (int c = 0; c < 3; ++c) {
                        non_finite += !std::isfinite(result.at(x, y, c));
                        far_changes +=
                            std::hypot(x - 100, y - 60) > reach && result.at(x, y, c) != expected.at(x, y, c);
                    }
                }
            }
            CAPTURE(level);
            CHECK(non_finite == 0);
            CHECK(far_changes == 0);
        }
    }
}

TEST_CASE("finite light of any size stays finite") {
    // Blocks of 2 pixels, so that blue's 3 pixels of displacement bring one sign to the other.
    const Image color = painted(160, 100, [](double x, double y) {
        const int block = static_cast<int>(std::floor(x / 2) + std::floor(y / 2));
        return block % 2 == 0 ? 3.4e38 : -3.4e38;
    });
    for (const Level level : all_levels) {
        int beyond = 0;
        for (float value : run(color, 0.05, level).values)
            beyond += !(std::abs(value) <= 65504);
        CHECK(beyond == 0);
    }
}

TEST_CASE("the default costs few samples, and strong aberration not more than the level's most") {
    const auto samples = [](int width, int height, double strength, Level level) {
        const Plan plan =
            plan_effect("chromatic_aberration", {.color = Image(width, height, 3)}, with(strength, level));
        const std::string& text = plan.passes.at(0).program->text;
        const auto constant_after = [&](const std::string& name) {
            const std::size_t at = text.find("const int CHROMATIC_ABERRATION_" + name + "_TAPS = ");
            REQUIRE(at != std::string::npos);
            return std::stoi(text.substr(text.find('=', at) + 1));
        };
        return constant_after("RED") + constant_after("BLUE");
    };
    CHECK(samples(1280, 720, 0.003, medium) == 2);
    CHECK(samples(1920, 1080, 0.003, medium) == 3);
    CHECK(samples(1280, 720, 0.003, ultra) == 3);
    CHECK(samples(3840, 2160, 0.05, medium) == 24);
    CHECK(samples(8000, 8000, 0.05, ultra) == 96);
    CHECK(samples(8000, 8000, 0.05, best) == 512);
}

TEST_CASE("with a shifted lens fringes are those of the part of a larger picture") {
    // A lens magnifies about its axis, and by the same share wherever the picture is cut.
    const Input whole{.color = noise(192, 108, 0, 1)};
    for (const Part& part : {Part{96, 0, 96, 108}, Part{0, 54, 192, 54}, Part{101, 61, 91, 47}}) {
        const Input input = part_of(whole, part);
        const double wide_strength = 0.02, strength = wide_strength * std::hypot(part.width, part.height)
                                                      / part.height / std::hypot(192, 108) * 108;
        for (const Level level : all_levels) {
            // Parts reach the corner that is farthest from the axis: there are as many samples of the spectrum.
            const Image wide = part_of(run(whole.color, wide_strength, level), part);
            const Image result = run_effect("chromatic_aberration", input, with(strength, level));
            // Farther from the part's border than any light moves, and than the cubic kernels reach.
            const double farthest = 0.02 * 108 * blue_end;
            const int border = static_cast<int>(std::ceil(farthest)) + 3;
            double worst = 0;
            for (int y = border; y < part.height - border; ++y) {
                for (int x = border; x < part.width - border; ++x) {
                    for (int c = 0; c < 3; ++c) {
                        worst = std::max(
                            worst, std::abs(static_cast<double>(result.at(x, y, c)) - wide.at(x, y, c)));
                    }
                }
            }
            INFO("level " << level << ", part at " << part.x << ", " << part.y);
            // Samplers' weights have 8 fractional bits; the cubic kernels' places are rounded to 1e-5 of a pixel.
            CHECK(worst <= (level < high ? 2 * 2 / 256.0 : 2 * 2 * 2e-5));
            const Worst exact = worst_difference(
                result, reference(reference_input("chromatic_aberration", input, with(strength, level))));
            CHECK(exact.absolute <= (level < high ? 2 * 2 / 256.0 : 2 * 2 * 2e-5));
        }
    }
}
