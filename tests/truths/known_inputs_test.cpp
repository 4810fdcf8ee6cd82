// Metrics on functions of which it is known what they have to find.
#include "effect_method.hpp"
#include "given_truth.hpp"

#include <catch2/catch.hpp>

#include <truths/film.hpp>
#include <truths/fourier.hpp>
#include <truths/lens_spectrum.hpp>
#include <truths/spline_picture.hpp>

#include <cmath>
#include <numbers>
#include <random>

using namespace postfx::testing;
using postfx::ChainEntry;
using postfx::Image64;
using postfx::host::MethodInput;

namespace {

Image64 unchanged(const ChainEntry&, const MethodInput& input) {
    return postfx::convert<double>(input.color);
}

/// 0.99 of the light in the channels from `first` on.
Image64 dimmed(const MethodInput& input, int first) {
    Image64 picture = postfx::convert<double>(input.color);
    for (std::size_t i = 0; i < picture.values.size(); ++i)
        picture.values[i] *= static_cast<int>(i % 3) >= first ? 0.99 : 1;
    return picture;
}

/// 31 pixels of a line, mean.
Image64 smeared(const ChainEntry&, const MethodInput& input) {
    constexpr int reach = 15;
    Image64 picture(input.color.width, input.color.height, 3);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            for (int i = -reach; i <= reach; ++i) {
                const int from = std::clamp(x + i, 0, picture.width - 1);
                for (int c = 0; c < 3; ++c)
                    picture.at(x, y, c) += static_cast<double>(input.color.at(from, y, c)) / (2 * reach + 1);
            }
        }
    }
    return picture;
}

/// Of mean 0 and variance 1, of another sequence for each frame, channel and patch.
std::vector<double> white_noise(std::size_t count, std::uint32_t frame, int channel, int place) {
    std::mt19937 engine(frame * 64 + static_cast<std::uint32_t>(channel * 16 + place));
    std::normal_distribution<double> normal;
    std::vector<double> values(count);
    for (double& value : values)
        value = normal(engine);
    return values;
}

double value_of(const ChainEntry& entry, const char* parameter) {
    return entry.values[*entry.effect->find_parameter(parameter)][0];
}

/// A Gaussian field with film's covariance: white noise, its cosine waves by the root of the spectrum. Away from the
/// border, where the mirror image counts, it has that covariance.
class FilmField {
public:
    FilmField(double diameter, double u) : roots_(side * side) {
        const postfx::host::FilmStatistics film(diameter);
        std::vector<double> rows(side * side); // sum over lags along x
        for (int j = 0; j <= film.reach(); ++j) {
            for (int i = 0; i <= film.reach(); ++i) {
                const double covariance = (i > 0 ? 2 : 1) * (j > 0 ? 2 : 1) * film.pixel_covariance(u, i, j)
                                          / film.pixel_variance(u);
                for (int y = 0; y < side; ++y) {
                    const double along = covariance * std::cos(std::numbers::pi * y * j / side);
                    for (int x = 0; x < side; ++x)
                        roots_[std::size_t(y * side + x)] +=
                            along * std::cos(std::numbers::pi * x * i / side);
                }
            }
        }
        for (double& root : roots_)
            root = std::sqrt(std::max(0.0, root));
    }
    static constexpr int patch = 128, border = 16, side = patch + 2 * border;

    std::vector<double> filtered(std::vector<double> noise) const {
        std::vector<double> waves = postfx::host::cosine_waves(std::move(noise), side, side);
        for (std::size_t i = 0; i < waves.size(); ++i)
            waves[i] *= roots_[i];
        return postfx::host::sum_of_waves(std::move(waves), side, side);
    }

private:
    std::vector<double> roots_;
};

/// Grain as film has it, or white.
Image64 grained(const ChainEntry& entry, const MethodInput& input, bool is_film) {
    Image64 picture = postfx::convert<double>(input.color);
    constexpr int patch = FilmField::patch, side = FilmField::side;
    const double amount = value_of(entry, "amount"), size = value_of(entry, "size") * picture.height;
    for (int place = 0; place < 8; ++place) {
        const int x0 = place % 4 * patch, y0 = place / 4 * patch;
        const double u = picture.at(x0, y0, 0);
        const FilmField field(1.75 * size, u);
        for (int channel = 0; channel < 3; ++channel) {
            std::vector<double> noise = white_noise(side * side, input.frame, channel, place);
            if (is_film) noise = field.filtered(std::move(noise));
            for (int y = 0; y < patch; ++y) {
                for (int x = 0; x < patch; ++x) {
                    const auto from =
                        static_cast<std::size_t>((y + FilmField::border) * side + x + FilmField::border);
                    picture.at(x0 + x, y0 + y, channel) += amount * std::sqrt(u * (1 - u)) * noise[from];
                }
            }
        }
    }
    return picture;
}

double shape_distance() {
    const FunctionMethod white("grain", [](const ChainEntry& entry, const MethodInput& input) {
        return grained(entry, input, false);
    });
    return measure("noise_distance", white);
}

} // namespace

TEST_CASE("exact glow measures as exact, no glow as all of the light misplaced") {
    const FunctionMethod exact("bloom", [](const ChainEntry& entry, const MethodInput& input) {
        std::map<std::string, double> values;
        for (std::size_t i = 0; i < entry.values.size(); ++i)
            values[entry.effect->parameters[i].id] = entry.values[i][0];
        return truth_of("bloom", "scene", postfx::convert<double>(input.color), values, 2).picture;
    });
    CHECK(measure("psf_l1", exact) < 1e-11);
    CHECK(measure("dc_gain", exact) < 1e-13);
    const FunctionMethod none("bloom", unchanged);
    CHECK(measure("psf_l1", none) > 1.7); // 2, less twice the share that stays in the pixel
    CHECK(measure("psf_l1", none) < 2);
    CHECK(measure("dc_gain", none) == 0);
    const FunctionMethod dark("bloom",
                              [](const ChainEntry&, const MethodInput& input) { return dimmed(input, 2); });
    CHECK(measure("dc_gain", dark) == Approx(0.01).epsilon(1e-9));
}

TEST_CASE("a lens that shows waves as they are has its edges in their places") {
    const FunctionMethod exact("chromatic_aberration", [](const ChainEntry& entry, const MethodInput& input) {
        const int width = input.color.width, height = input.color.height;
        const postfx::host::LensSpectrum spectrum(value_of(entry, "strength"), width, height);
        const postfx::host::SplinePicture picture(postfx::convert<double>(input.color));
        constexpr int wavelengths = 12;
        Image64 result(width, height, 3);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    for (int i = 0; i < wavelengths; ++i) {
                        const double scale = 1 + spectrum.displacement(c, (i + 0.5) / wavelengths);
                        result.at(x, y, c) += picture.at(width / 2.0 + (x + 0.5 - width / 2.0) * scale,
                                                         height / 2.0 + (y + 0.5 - height / 2.0) * scale, c)
                                              / wavelengths;
                    }
                }
            }
        }
        return result;
    });
    // 12 wavelengths take a kernel's root for a staircase: 12^-1.5 / 4 of blue's 2 pixels at most.
    CHECK(measure("edge_position", exact) < 0.01);
    CHECK(measure("energy", exact) < 1e-4);
    const FunctionMethod none("chromatic_aberration", unchanged);
    // Blue's edge 230 px from the centre moves by 2/3 of 0.67 times 0.01 picture heights over 294 px.
    CHECK(measure("edge_position", none) == Approx(230 * 2.0 / 3 * 0.668 * 2.88 / 293.7).epsilon(0.02));
    CHECK(measure("energy", none) == Approx(2 * 2.0 / 3 * 0.668 * 2.88 / 293.7).epsilon(0.02));
}

TEST_CASE("film's own statistics are at no distance, white noise is") {
    const FunctionMethod film("grain", [](const ChainEntry& entry, const MethodInput& input) {
        return grained(entry, input, true);
    });
    const double white = shape_distance();
    // The estimate's own noise, as a share of the deviation 0.0225: 1 %.
    CHECK(measure("noise_distance", film) < 0.01 * 0.0225);
    CHECK(measure("variance", film) < 0.015); // 24 patches over the area of a covariance: sqrt(2 / 24 / 2500)
    CHECK(white > 0.4 * 0.0225);
    const FunctionMethod none("grain", unchanged);
    // All of the deviation: 0.03 times the root mean square of u (1 - u) over that of u.
    CHECK(measure("noise_distance", none) == Approx(0.03 * std::sqrt(0.16796875 / 0.33203125)).epsilon(0.02));
    CHECK(measure("variance", none) == Approx(1).epsilon(1e-12));
    const FunctionMethod bright("grain", [](const ChainEntry& entry, const MethodInput& input) {
        Image64 picture = grained(entry, input, true);
        for (double& value : picture.values)
            value += 0.01;
        return picture;
    });
    CHECK(measure("noise_distance", bright) == Approx(0.01 / std::sqrt(0.33203125)).epsilon(0.01));
}

TEST_CASE("a lens that blurs without looking at depth leaks") {
    const FunctionMethod none("depth_of_field", unchanged);
    CHECK(measure("leakage", none) == 0);
    CHECK(measure("energy", none) == 0);
    const FunctionMethod blur("depth_of_field", smeared);
    // Of 31 pixels' mean, beyond an edge: 15/31, 14/31, ... over the 21 pixels of the largest circle.
    CHECK(measure("leakage", blur) == Approx(120.0 / 31 / 21).epsilon(1e-9));
    CHECK(measure("energy", blur) < 1e-12);
    const FunctionMethod dark("depth_of_field",
                              [](const ChainEntry&, const MethodInput& input) { return dimmed(input, 0); });
    CHECK(measure("energy", dark) == Approx(0.01).epsilon(1e-9));
}
