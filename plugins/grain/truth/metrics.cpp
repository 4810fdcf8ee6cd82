// How far an effect's grain is from the statistics of film.
#include "film.hpp"

#include <truths/fourier.hpp>
#include <truths/metric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::host {
namespace {

/// Patches of one light each, in two rows of four, and as many pictures.
constexpr int patch = 128, across = 4, down = 2, levels = across * down, frames = 8;
/// The pictures that the entry's size is meant for: grain that is smaller than a pixel has no shape to be wrong.
constexpr double rows = 1080;
/// Larger amounts would be cut at black and white.
constexpr double most_amount = 0.1;

double light_of(int level) {
    return (level + 0.5) / levels;
}

/// Frequencies i, j / patch waves per pixel that are taken together. The columns 0 and patch / 2 hold each wave twice
/// and are left out.
constexpr int bin_width = 3, bin_height = 4, bins_across = (patch / 2 - 1) / bin_width,
              bins_up = patch / bin_height, bins = bins_across * bins_up;
using Spectrum = std::array<double, bins>; ///< power per pixel, of means over bins

Spectrum binned(const std::vector<double>& power) {
    Spectrum spectrum{};
    for (std::size_t y = 0; y < patch; ++y) {
        for (std::size_t x = 1; x <= bins_across * bin_width; ++x) {
            spectrum[y / bin_height * bins_across + (x - 1) / bin_width] +=
                power[y * (patch / 2 + 1) + x] / (bin_width * bin_height);
        }
    }
    return spectrum;
}

/// Noise of one level of light.
struct NoiseStatistics {
    double mean = 0, variance = 0;
    double power_of_mean = 0; ///< at the frequency 0: patch^2 times the variance of a patch's mean
    Spectrum spectrum{};
};

double value_of(const ChainEntry& entry, const char* parameter) {
    return entry.values[*entry.effect->find_parameter(parameter)][0];
}

/// What the entry asks for, of film.
struct AskedFilm {
    double size, deviation; ///< of grains [px]; of a pixel, over sqrt(u (1 - u))

    explicit AskedFilm(const ChainEntry& entry) {
        size = value_of(entry, "size") * down * patch;
        deviation = value_of(entry, "amount") * std::min(1.0, size);
    }

    NoiseStatistics statistics(double u) const {
        const FilmStatistics layer(disc_per_grain * size);
        const double scale = deviation * deviation * u * (1 - u) / layer.pixel_variance(u);
        // A patch shows a covariance as often as two of its pixels are so far apart.
        const int reach = std::min(layer.reach(), patch / 2 - 1);
        std::vector<double> covariances(static_cast<std::size_t>(patch) * patch);
        for (int j = -reach; j <= reach; ++j) {
            for (int i = -reach; i <= reach; ++i) {
                const double seen = (1 - std::abs(i) / double(patch)) * (1 - std::abs(j) / double(patch));
                const int x = (i + patch) % patch, y = (j + patch) % patch;
                covariances[static_cast<std::size_t>(y) * patch + static_cast<std::size_t>(x)] =
                    seen * scale * layer.pixel_covariance(u, std::abs(i), std::abs(j));
            }
        }
        // Their transform is positive: its magnitude, from the periodogram.
        std::vector<double> power = periodogram(std::move(covariances), patch, patch);
        for (double& value : power)
            value = patch * std::sqrt(value);
        return {0, deviation * deviation * u * (1 - u), power[0], binned(power)};
    }
};

/// The entry as it is measured: at the size that its grain has in pictures of 1080 rows.
ChainEntry grain(const Method& method) {
    const ChainEntry& asked = method.entry();
    return entry_with(method, {{"size", value_of(asked, "size") * rows / (down * patch)},
                               {"amount", std::min(value_of(asked, "amount"), most_amount)},
                               {"color", 1}}); // each channel tells something of its own
}

/// Patches of an entry, measured.
std::array<NoiseStatistics, levels> measured(const Method& method, const ChainEntry& entry) {
    std::array<NoiseStatistics, levels> result{};
    Image color(across * patch, down * patch, 3);
    const auto level_at = [](int x, int y) { return x / patch + y / patch * across; };
    for (int y = 0; y < color.height; ++y) {
        for (int x = 0; x < color.width; ++x)
            std::fill_n(color.pixel(x, y), 3, static_cast<float>(light_of(level_at(x, y))));
    }
    constexpr double share = 1.0 / (3 * frames), pixels = patch * patch;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const Image64 found = method.draw(entry, {.color = color, .time = frame / 60.0, .frame = frame});
        for (int level = 0; level < levels; ++level) {
            NoiseStatistics& noise = result[static_cast<std::size_t>(level)];
            for (int channel = 0; channel < 3; ++channel) {
                std::vector<double> values;
                for (int y = 0; y < patch; ++y) {
                    for (int x = 0; x < patch; ++x) {
                        const double value =
                            found.at(level % across * patch + x, level / across * patch + y, channel)
                            - light_of(level);
                        values.push_back(value);
                        noise.mean += share * value / pixels;
                        noise.variance += share * value * value / pixels;
                    }
                }
                const Spectrum spectrum = binned(periodogram(std::move(values), patch, patch));
                for (std::size_t i = 0; i < bins; ++i)
                    noise.spectrum[i] += share * spectrum[i];
            }
        }
    }
    for (NoiseStatistics& noise : result)
        noise.variance -= noise.mean * noise.mean;
    return result;
}

/// The smallest root mean square difference that two pictures can have of which one has the effect's mean and
/// spectrum and the other film's: the 2-Wasserstein distance of stationary Gaussian fields, whose square is the mean
/// over frequencies of (sqrt(S) - sqrt(S'))^2, plus that of the means (Gelbrich 1990); root of its mean over the
/// levels of light, as a share of their root mean square. Skewness and the rest are not in it.
double noise_distance(const Method& method) {
    const ChainEntry entry = grain(method);
    const std::array<NoiseStatistics, levels> found = measured(method, entry);
    // A bin is a mean of so many squares of complex Gaussians; their root is too small by this factor on average, and
    // the bins' number makes what is left of their noise some 0.5 % of the deviation.
    constexpr double count = 3 * frames * bin_width * bin_height;
    const double root_bias = std::exp(std::lgamma(count + 0.5) - std::lgamma(count)) / std::sqrt(count);
    double sum = 0, light = 0;
    for (int level = 0; level < levels; ++level) {
        const NoiseStatistics& noise = found[static_cast<std::size_t>(level)];
        const NoiseStatistics film = AskedFilm(entry).statistics(light_of(level));
        for (std::size_t i = 0; i < bins; ++i) {
            const double product = std::sqrt(noise.spectrum[i] * film.spectrum[i]);
            sum += (noise.spectrum[i] + film.spectrum[i] - 2 * product / root_bias) / bins;
        }
        // Film's own mean would be this far off over as many pixels.
        sum += noise.mean * noise.mean - film.power_of_mean / (3.0 * frames * patch * patch);
        light += light_of(level) * light_of(level);
    }
    return std::sqrt(std::max(0.0, sum) / light);
}

/// Mean over the levels of light of |variance / film's - 1|. Its own noise is some 0.3 %.
double variance_error(const Method& method) {
    const ChainEntry entry = grain(method);
    const std::array<NoiseStatistics, levels> found = measured(method, entry);
    double sum = 0;
    for (int level = 0; level < levels; ++level) {
        const double film = AskedFilm(entry).statistics(light_of(level)).variance;
        sum += std::abs(found[static_cast<std::size_t>(level)].variance / film - 1);
    }
    return sum / levels;
}

const RegisterMetric distance_metric(
    "grain", "noise_distance", "",
    "distance of mean and spectrum from film's, as a share of the light; grain as in 1080 rows",
    noise_distance, true),
    variance_metric("grain", "variance", "",
                    "relative error of the noise's variance, mean over 8 levels of light", variance_error);

} // namespace
} // namespace postfx::host
