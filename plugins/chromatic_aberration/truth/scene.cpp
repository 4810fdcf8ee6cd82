// Lateral chromatic aberration as a lens makes it: the scene drawn again with the magnification of each wavelength.
// No picture has to be rebuilt between its pixels, and what lies outside of it is seen.
#include "lens_spectrum.hpp"

#include <truths/drawn_scene.hpp>
#include <truths/sampling.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace postfx::host {
namespace {

/// The camera that sees `scale` times as much on both axes.
Camera magnified(Camera camera, double scale) {
    constexpr double degree = std::numbers::pi / 180;
    camera.vertical_fov = 2 * std::atan(camera.tan_half_fov() * scale) / degree;
    camera.vertical_extent *= scale;
    return camera;
}

class Magnifications : public Truth {
public:
    static constexpr bool takes_given = false;

    explicit Magnifications(const TruthRequest& request)
        : renderer_(request.scene, {.samples = request.scene_samples}),
          camera_(request.scene.camera_at(request.time)), time_(request.time),
          strength_(request.value("strength")), spectrum_(strength_, request.width, request.height) {}

    std::string description(int samples) const override {
        return fmt::format("the scene drawn with the magnifications of {} wavelengths per channel", samples);
    }
    std::string values() const override { return fmt::format("strength {}", strength_); }
    int channels() const override { return 3; }

    void add(int index, Image64& sum) override {
        constexpr std::uint32_t wavelengths_seed = 0x6c61u;
        const double quantile = truth_point(index, wavelengths_seed).x;
        for (int channel = 0; channel < 3; ++channel) {
            const Camera camera = magnified(camera_, 1 + spectrum_.displacement(channel, quantile));
            const SceneFrame frame =
                renderer_.render(sum.width, sum.height, time_, {"color"}, CameraOverride{camera});
            const Image64 light = read_light(frame, "color", sum.width, sum.height);
            for (std::size_t i = static_cast<std::size_t>(channel); i < light.values.size(); i += 3)
                sum.values[i] += light.values[i];
        }
    }

    Image64 picture(const Image64& sum, int count) const override { return mean_of(sum, count); }

private:
    SceneRenderer renderer_;
    Camera camera_;
    double time_;
    double strength_;
    LensSpectrum spectrum_;
};

const RegisterTruth<Magnifications> registered("chromatic_aberration", "scene",
                                               "the scene drawn with the magnification of each wavelength",
                                               128);

} // namespace
} // namespace postfx::host
