// Fog along each pixel's ray, by quadrature.
#include "fog_path.hpp"

#include <image/rows.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/truth.hpp>
#include <truths/view_rays.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// Where the sky is taken to be [m].
constexpr double sky_distance = 1e20;

class FogAlongRays : public Truth {
public:
    explicit FogAlongRays(const TruthRequest& request)
        : values_(request.all_values()), light_(request.color("color")),
          max_opacity_(request.value("max_opacity")) {
        SceneRenderer renderer(request.scene, {.samples = request.scene_samples});
        const SceneFrame frame =
            renderer.render(request.width, request.height, request.time, {"color", "depth"});
        color_ = given_light(request, frame);
        find_paths(request, frame.camera, read_attachment(frame, "depth", request.width, request.height));
    }

    std::string description(int) const override {
        return "density summed up along each ray by adaptive Gauss-Kronrod quadrature, and the equation of "
               "light on its way by adaptive Runge-Kutta steps; the error is what the two are apart";
    }
    std::string values() const override { return values_; }
    int channels() const override { return 2; }

    void add(int index, Image64& sum) override {
        for_each_row(sum.height, [&](int y) {
            for (int x = 0; x < sum.width; ++x) {
                const FogPath& path = paths_[static_cast<std::size_t>(y) * sum.width + x];
                const FogShares shares = index % 2 == 0 ? fog_by_thickness(path) : fog_by_transfer(path);
                sum.at(x, y, 0) += shares.transmittance;
                sum.at(x, y, 1) += shares.opacity;
            }
        });
    }

    Image64 picture(const Image64& sum, int count) const override {
        Image64 result = color_;
        for (std::size_t i = 0; i < result.values.size(); ++i) {
            const double* shares = &sum.values[i / 3 * 2];
            const double transmittance = std::max(shares[0] / count, 1 - max_opacity_);
            const double opacity = std::min(shares[1] / count, max_opacity_);
            result.values[i] = transmittance * color_.values[i] + opacity * light_[i % 3];
        }
        return result;
    }

private:
    /// The part of each pixel's ray that runs through fog; of no length where there is none.
    void find_paths(const TruthRequest& request, const Camera& camera, const Image& depth) {
        const ViewRays rays(camera, request.width, request.height);
        const double start = request.value("start"), base = request.value("base_height");
        const bool covers_sky = request.value("sky") != 0;
        paths_.resize(depth.pixel_count());
        for (int y = 0; y < depth.height; ++y) {
            for (int x = 0; x < depth.width; ++x) {
                const double z = camera.view_z(depth.at(x, y, 0));
                const bool is_sky = std::isinf(z);
                const ViewRay ray = rays.through(x + 0.5, y + 0.5);
                const double whole = is_sky ? (covers_sky ? sky_distance : 0) : ray.length_to(z);
                paths_[static_cast<std::size_t>(y) * depth.width + x] = {
                    .density = request.value("density"),
                    .falloff = request.value("height_falloff"),
                    .height = ray.origin.y + start * ray.direction.y - base,
                    .rise = ray.direction.y,
                    .length = std::max(whole - start, 0.0)};
            }
        }
    }

    std::string values_;
    std::array<double, 3> light_;
    double max_opacity_;
    Image64 color_;
    std::vector<FogPath> paths_;
};

const RegisterTruth<FogAlongRays> registered("fog", "scene", "quadrature along each pixel's ray", 2);

} // namespace
} // namespace postfx::host
