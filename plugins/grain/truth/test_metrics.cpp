// Grain's metrics on noise of which it is known what they have to find.
#include <catch2/catch.hpp>

#include "film.hpp"

#include <effect_method.hpp>
#include <truths/fourier.hpp>

#include <cmath>
#include <numbers>
#include <random>

using postfx::ChainEntry;
using postfx::Image64;
using postfx::host::MethodInput;
using namespace postfx::testing;

namespace {

/// Of mean 0 and variance 1, of another sequence for each frame, channel and patch.
std::vector<double> white_noise(std::size_t count, std::uint32_t frame, int channel, int place) {
    std::mt19937 engine(frame * 64 + static_cast<std::uint32_t>(channel * 16 + place));
    std::normal_distribution<double> normal;
    std::vector<double> values(count);
    for (double& value : values)
        value = normal(engine);
    return values;
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
