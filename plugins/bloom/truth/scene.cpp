// Bloom as what it stands for: the picture convolved with the whole kernel, by cosine transforms, of which a mirrored
// border is the nature.
#include "glow_kernel.hpp"

#include <truths/drawn_scene.hpp>
#include <truths/fourier.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::host {
namespace {

/// The largest half float, where light ends.
constexpr double most_light = 65504;

enum class Mode { scatter, threshold, emission };

double brightest(const double* light) {
    return std::max({light[0], light[1], light[2]});
}

/// What glows, pixel by pixel: NaN, negative and infinite light taken out, a pixel that outshines its neighbours held
/// back, the threshold taken off.
class GlowSource {
public:
    explicit GlowSource(const TruthRequest& request)
        : has_threshold_(static_cast<Mode>(request.value("mode")) == Mode::threshold),
          threshold_(request.value("threshold")), knee_(threshold_ * request.value("knee")),
          guard_(request.value("firefly_guard")) {}

    Image64 of(Image64 light) const {
        for (double& value : light.values)
            value = std::isnan(value) ? 0 : std::clamp(value, 0.0, most_light);
        if (guard_ > 0) light = guarded(light);
        if (!has_threshold_) return light;
        for (std::size_t i = 0; i < light.values.size(); i += 3) {
            const double brightness = brightest(&light.values[i]);
            const double share = brightness > 0 ? passed(brightness) / brightness : 0;
            for (std::size_t c = 0; c < 3; ++c)
                light.values[i + c] *= share;
        }
        return light;
    }

private:
    /// Above the threshold less the threshold; around it a parabola that meets both sides with their slopes.
    double passed(double brightness) const {
        const double above = brightness - threshold_;
        if (above >= knee_) return above;
        if (above <= -knee_) return 0;
        return (above + knee_) * (above + knee_) / (4 * knee_);
    }

    Image64 guarded(const Image64& light) const {
        Image64 result = light;
        const auto neighbour = [&](int x, int y) {
            return brightest(
                light.pixel(std::clamp(x, 0, light.width - 1), std::clamp(y, 0, light.height - 1)));
        };
        for (int y = 0; y < light.height; ++y) {
            for (int x = 0; x < light.width; ++x) {
                double around = -neighbour(x, y);
                for (int j = -1; j <= 1; ++j) {
                    for (int i = -1; i <= 1; ++i)
                        around += neighbour(x + i, y + j);
                }
                const double allowed = std::max(0.0, around) / 8 / guard_, own = neighbour(x, y);
                if (own <= allowed) continue;
                for (int c = 0; c < 3; ++c)
                    result.at(x, y, c) *= allowed / own;
            }
        }
        return result;
    }

    bool has_threshold_;
    double threshold_, knee_, guard_;
};

class Convolution : public Truth {
public:
    explicit Convolution(const TruthRequest& request)
        : width_(request.width), height_(request.height), scatters_(mode_of(request) == Mode::scatter),
          intensity_(request.value("radius") > 0 ? request.value("intensity") : 0), // neither: no glow
          deviation_(request.value("radius") * request.height), tint_(request.color("tint")) {
        Image64 source;
        if (mode_of(request) == Mode::emission) {
            SceneRenderer renderer(request.scene, {.samples = request.scene_samples});
            const SceneFrame frame = renderer.render(width_, height_, request.time, {"color", "emission"});
            light_ = given_light(request, frame);
            source = read_light(frame, "emission", width_, height_);
        } else {
            source = light_ = given_light(request);
        }
        source = GlowSource(request).of(std::move(source));
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<double> channel;
            for (std::size_t i = c; i < source.values.size(); i += 3)
                channel.push_back(source.values[i]);
            waves_[c] = cosine_waves(std::move(channel), width_, height_);
        }
    }

    std::string description(int) const override {
        return fmt::format("float64 convolution by cosine transforms, border mirrored, the kernel's integral "
                           "over widths by {} and by {} nodes",
                           nodes_of(0), nodes_of(1));
    }
    std::string values() const override { return fmt::format("deviation {} px", deviation_); }
    /// The share that the kernel leaves of each wave.
    int channels() const override { return 1; }

    void add(int index, Image64& sum) override {
        const GlowKernel kernel(deviation_, nodes_of(index));
        const std::vector<double> shares = shares_left(kernel, width_, height_);
        std::transform(shares.begin(), shares.end(), sum.values.begin(), sum.values.begin(), std::plus<>());
    }

    Image64 picture(const Image64& sum, int count) const override {
        Image64 result = light_;
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<double> waves = waves_[c];
            for (std::size_t i = 0; i < waves.size(); ++i)
                waves[i] *= sum.values[i] / count;
            const std::vector<double> glow = sum_of_waves(std::move(waves), width_, height_);
            for (std::size_t i = 0; i < glow.size(); ++i) {
                double& light = result.values[3 * i + c];
                const double added = intensity_ * tint_[c] * glow[i];
                light = scatters_ ? (1 - intensity_) * light + added
                                  : light + std::min(added, std::max(0.0, most_light - light));
            }
        }
        return result;
    }

private:
    static Mode mode_of(const TruthRequest& request) { return static_cast<Mode>(request.value("mode")); }
    static int nodes_of(int index) { return index % 2 == 0 ? 32 : 64; }

    int width_, height_;
    bool scatters_; ///< or else the glow is added
    double intensity_, deviation_;
    std::array<double, 3> tint_;
    Image64 light_;
    std::array<std::vector<double>, 3> waves_; ///< of what glows
};

const RegisterTruth<Convolution> registered("bloom", "scene",
                                            "the picture convolved with the whole kernel in float64", 2);

} // namespace
} // namespace postfx::host
