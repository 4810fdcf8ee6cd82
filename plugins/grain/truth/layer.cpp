// Film grain by its making: layers of discs, seen through the pixels' squares.
#include "film.hpp"

#include <image/rows.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/sampling.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// A layer has the deviation sqrt(u (1 - u)), n of them sqrt(u (1 - u) / n): `amount` is that of 1 / amount^2 layers.
/// More than 32 only make the noise more Gaussian than it is already.
int layers_of(double amount) {
    constexpr int most = 32;
    return amount * amount * most <= 1 ? most : static_cast<int>(std::lround(1 / (amount * amount)));
}

class FilmLayers : public Truth {
public:
    explicit FilmLayers(const TruthRequest& request)
        : amount_(request.value("amount")), size_(request.value("size") * request.height),
          color_(request.value("color")), layers_(layers_of(amount_)), seed_(request.value("seed")),
          film_(disc_per_grain * size_, static_cast<std::uint64_t>(seed_) << 32u | request.frame),
          light_(given_light(request)) {
        // Some layers are common to the channels, some are a channel's own.
        if (color_ > 0) own_layers_ = color_ < 1 ? std::max(1, int(std::lround(color_ * layers_))) : layers_;
        if (color_ < 1) common_layers_ = std::max(1, layers_ - own_layers_);
        for (const double light : light_.values)
            bareness_.push_back(Film::bareness(light));
    }

    std::string description(int samples) const override {
        return fmt::format(
            "{} layers of discs of {:.3g} px, {} places in each pixel, deviation scaled to what "
            "the effect's values ask for",
            common_layers_ + own_layers_, disc_per_grain * size_, samples);
    }
    std::string values() const override {
        return fmt::format("size {} px, color {}, {} layers, seed {}", size_, color_, layers_, seed_);
    }
    /// Noise of variance 1 at a point, per channel.
    int channels() const override { return 3; }

    void add(int index, Image64& sum) override {
        constexpr std::uint32_t places_seed = 0x6772u;
        const glm::dvec2 place = truth_point(index, places_seed);
        for_each_row(sum.height, [&](int y) {
            for (int x = 0; x < sum.width; ++x) {
                for (int channel = 0; channel < 3; ++channel)
                    sum.at(x, y, channel) += noise(x, y, channel, place);
            }
        });
    }

    Image64 picture(const Image64& sum, int count) const override {
        const FilmStatistics statistics(disc_per_grain * size_);
        Image64 result = light_;
        for (std::size_t i = 0; i < result.values.size(); ++i) {
            double& light = result.values[i];
            if (!has_grain(light)) continue;
            const double u = grainy_light(light);
            // A field is at least -sqrt(u / (1 - u)) * largest_field() where nothing is covered, at most the same of
            // 1 - u where all is: up to that deviation the picture stays within 0..1 by itself, and keeps its mean.
            const double wanted =
                amount_ * std::min(1.0, size_) * u * (1 - u) / std::sqrt(statistics.pixel_variance(u));
            const double possible = std::sqrt(u * (1 - u)) / largest_field();
            light += std::min(wanted, possible) * sum.values[i] / count;
        }
        return result;
    }

private:
    /// In units of sqrt(u / (1 - u)) or its inverse.
    double largest_field() const {
        return std::sqrt((1 - color_) * common_layers_) + std::sqrt(color_ * own_layers_);
    }

    static bool has_grain(double light) { return light > 0 && light < 1; }

    double noise(int x, int y, int channel, glm::dvec2 place) const {
        const auto pixel = 3 * (static_cast<std::size_t>(y) * light_.width + x) + channel;
        if (!has_grain(light_.values[pixel])) return 0;
        const int first_own = common_layers_ + channel * own_layers_;
        return std::sqrt(1 - color_) * covered(0, common_layers_, pixel, x + place.x, y + place.y)
               + std::sqrt(color_)
                     * covered(first_own, first_own + own_layers_, pixel, x + place.x, y + place.y);
    }

    /// How many of those layers cover the place, as a number of mean 0 and variance 1.
    double covered(int first, int last, std::size_t pixel, double x, double y) const {
        if (last == first) return 0;
        const double u = grainy_light(light_.values[pixel]);
        int count = 0;
        for (int layer = first; layer < last; ++layer)
            count += film_.is_covered(layer, x, y, bareness_[pixel]) ? 1 : 0;
        const int layers = last - first;
        return (count - layers * u) / std::sqrt(layers * u * (1 - u));
    }

    double amount_, size_, color_; ///< size in pixels
    int layers_, common_layers_ = 0, own_layers_ = 0;
    double seed_;
    Film film_;
    Image64 light_;
    std::vector<double> bareness_; ///< per number of light_
};

const RegisterTruth<FilmLayers>
    registered("grain", "layer", "layers of film as discs at random places, seen through the pixels' squares",
               64, RegisterTruth<FilmLayers>::Compared::statistics);

} // namespace
} // namespace postfx::host
