// Ambient occlusion as well as one layer of depth and normals allows: every pixel of the height field counts.
#include "height_field.hpp"
#include "occluded_light.hpp"

#include <image/rows.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/sampling.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>

#include <numbers>

namespace postfx::host {
namespace {

class OcclusionSlices : public Truth {
public:
    explicit OcclusionSlices(const TruthRequest& request)
        : OcclusionSlices(request, SceneRenderer(request.scene, {.samples = request.scene_samples})) {}

    std::string description(int samples) const override {
        return fmt::format("{} slices of the depth buffer through each pixel, over every pixel on their way",
                           samples);
    }
    std::string values() const override { return values_; }
    int channels() const override { return 1; }

    void add(int index, Image64& sum) override {
        for_each_row(sum.height, [&](int y) {
            for (int x = 0; x < sum.width; ++x) {
                double& value = sum.at(x, y, 0);
                const auto pixel = static_cast<std::uint32_t>(y * sum.width + x);
                value += field_.visibility(x, y, std::numbers::pi * truth_point(index, mix_bits(pixel)).x);
            }
        });
    }

    Image64 picture(const Image64& sum, int count) const override { return light_.picture(sum, count); }

private:
    OcclusionSlices(const TruthRequest& request, SceneRenderer renderer)
        : OcclusionSlices(request, renderer.render(request.width, request.height, request.time,
                                                   {"color", "depth", "normal", "ambient"})) {}

    OcclusionSlices(const TruthRequest& request, const SceneFrame& frame)
        : values_(fmt::format("radius {} m, falloff {}", request.value("radius"), request.value("falloff"))),
          field_(read_attachment(frame, "depth", request.width, request.height),
                 read_attachment(frame, "normal", request.width, request.height), frame.camera,
                 request.value("radius"), request.value("falloff")),
          light_(request, frame) {}

    std::string values_;
    HeightField field_;
    OccludedLight light_;
};

const RegisterTruth<OcclusionSlices>
    registered("ssao", "layer", "one layer of depth and normals as a height field, every pixel of it", 256);

} // namespace
} // namespace postfx::host
