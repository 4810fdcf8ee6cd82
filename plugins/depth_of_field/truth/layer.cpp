// Depth of field as well as one layer of colour and depth allows: what the effect is given, seen from many points of
// the lens.
#include "layer_lens.hpp"

#include <truths/drawn_scene.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

namespace postfx::host {
namespace {

class LayerPositions : public Truth {
public:
    explicit LayerPositions(const TruthRequest& request)
        : lens_(thin_lens(request, request.scene.camera_at(request.time))), layer_(draw(request)) {}

    std::string description(int samples) const override {
        return fmt::format(
            "{} lens positions over one layer of colour and depth, no limit on circles of confusion",
            samples);
    }
    std::string values() const override { return lens_.text(); }
    int channels() const override { return LayerLens::channels; }
    void add(int index, Image64& sum) override { layer_.add(lens_point(index), sum); }
    Image64 picture(const Image64& sum, int) const override { return layer_.picture(sum); }

private:
    LayerLens draw(const TruthRequest& request) const {
        const int width = request.width, height = request.height;
        SceneRenderer renderer(request.scene, {.samples = request.scene_samples});
        const SceneFrame frame = renderer.render(width, height, request.time, {"color", "depth"});
        const Image depth = read_attachment(frame, "depth", width, height);
        std::vector<double> inverse_distance;
        for (const float sample : depth.values)
            inverse_distance.push_back(1 / frame.camera.view_z(sample));
        return {given_light(request, frame), std::move(inverse_distance), lens_};
    }

    ThinLens lens_;
    LayerLens layer_;
};

const RegisterTruth<LayerPositions>
    registered("depth_of_field", "layer", "one layer of colour and depth seen from many points of the lens",
               1024);

} // namespace
} // namespace postfx::host
