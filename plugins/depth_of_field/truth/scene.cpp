// Depth of field as a camera makes it: the scene drawn again from many points of the lens, with off-axis frusta that
// share the plane in focus (Haeberli and Akeley 1990, "The accumulation buffer").
#include "thin_lens.hpp"

#include <truths/drawn_scene.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

namespace postfx::host {
namespace {

class LensPositions : public Truth {
public:
    static constexpr bool takes_given = false;

    explicit LensPositions(const TruthRequest& request)
        : renderer_(request.scene, {.samples = request.scene_samples}),
          camera_(request.scene.camera_at(request.time)), lens_(thin_lens(request, camera_)),
          time_(request.time), width_(request.width), height_(request.height) {}

    std::string description(int samples) const override {
        return fmt::format("{} lens positions, off-axis frusta, no limit on circles of confusion", samples);
    }
    std::string values() const override { return lens_.text(); }
    int channels() const override { return 3; }

    void add(int index, Image64& sum) override {
        const glm::dvec2 position = lens_.aperture / 2 * lens_point(index);
        if (lens_.achromatic()) {
            const Image64 light = draw(position, lens_.focus[1]);
            for (std::size_t i = 0; i < light.values.size(); ++i)
                sum.values[i] += light.values[i];
            return;
        }
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Image64 light = draw(position, lens_.focus[channel]);
            for (std::size_t i = channel; i < light.values.size(); i += 3)
                sum.values[i] += light.values[i];
        }
    }

    Image64 picture(const Image64& sum, int count) const override { return mean_of(sum, count); }

private:
    /// From `position` [m] on the lens. The frustum is shifted so that the plane at 1 / `focus` stays where it is.
    Image64 draw(glm::dvec2 position, double focus) {
        CameraOverride view{camera_, -position * focus / lens_.half_extent};
        std::array<double, 16>& place = view.camera.view_to_world; // columns: right, up, backward, position
        for (std::size_t row = 0; row < 3; ++row)
            place[12 + row] += position.x * place[row] + position.y * place[4 + row];
        const SceneFrame frame = renderer_.render(width_, height_, time_, {"color"}, view);
        return read_light(frame, "color", width_, height_);
    }

    SceneRenderer renderer_;
    Camera camera_;
    ThinLens lens_;
    double time_;
    int width_, height_;
};

const RegisterTruth<LensPositions> registered("depth_of_field", "scene",
                                              "the scene drawn from many points of the lens", 1024);

} // namespace
} // namespace postfx::host
