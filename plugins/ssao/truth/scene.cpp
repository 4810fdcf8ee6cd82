// Ambient occlusion of the scene itself: rays from what each pixel shows, against the scene's triangles.
#include "occluded_light.hpp"

#include <image/rows.hpp>
#include <scene/projection.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/sampling.hpp>
#include <truths/scene_rays.hpp>
#include <truths/truth.hpp>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// What a pixel's middle shows, in world space.
struct SurfacePoint {
    glm::dvec3 position{0}, normal{0}; ///< metres; a normal of 0: nothing there that could be occluded
};

/// A direction over `normal`, with a density that is its cosine over pi.
glm::dvec3 cosine_direction(glm::dvec3 normal, glm::dvec2 square) {
    const glm::dvec2 disc = disc_point(square);
    // A basis without a bad case (Duff et al. 2017).
    const double sign = std::copysign(1.0, normal.z), a = -1 / (sign + normal.z), b = normal.x * normal.y * a;
    const glm::dvec3 right(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    const glm::dvec3 up(b, sign + normal.y * normal.y * a, -normal.y);
    const double height = std::sqrt(std::max(0.0, 1 - glm::dot(disc, disc)));
    return disc.x * right + disc.y * up + height * normal;
}

class OcclusionRays : public Truth {
public:
    explicit OcclusionRays(const TruthRequest& request)
        : rays_(request.scene, request.time), radius_(request.value("radius")),
          falloff_(request.value("falloff")), light_(draw_light(request)) {
        find_points(request);
    }

    std::string description(int samples) const override {
        return fmt::format(
            "{} cosine-weighted rays per pixel against the scene's triangles, from pixels' middles", samples);
    }
    std::string values() const override { return fmt::format("radius {} m, falloff {}", radius_, falloff_); }
    int channels() const override { return 1; }

    void add(int index, Image64& sum) override {
        for_each_row(sum.height, [&](int y) {
            for (int x = 0; x < sum.width; ++x) {
                const auto pixel = static_cast<std::size_t>(y) * sum.width + x;
                sum.values[pixel] += visibility(pixel, index);
            }
        });
    }

    Image64 picture(const Image64& sum, int count) const override { return light_.picture(sum, count); }

private:
    static OccludedLight draw_light(const TruthRequest& request) {
        SceneRenderer renderer(request.scene, {.samples = request.scene_samples});
        return {request, renderer.render(request.width, request.height, request.time, {"color", "ambient"})};
    }

    /// With one sample per pixel, so that depth is that of one point of a surface. Its normal is the triangle's: the one
    /// that is shaded may look away from the viewer, or into the surface.
    void find_points(const TruthRequest& request) {
        const int width = request.width, height = request.height;
        SceneRenderer renderer(request.scene, {.samples = 1});
        const SceneFrame frame = renderer.render(width, height, request.time, {"depth"});
        const Image depth = read_attachment(frame, "depth", width, height);
        const glm::dmat4 to_world = glm::make_mat4(frame.camera.view_to_world.data());
        const Projection projection = make_projection(frame.camera, static_cast<double>(width) / height);
        points_.resize(depth.values.size());
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double z = frame.camera.view_z(depth.at(x, y, 0));
                if (std::isinf(z)) continue;
                const glm::dvec2 screen(2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1);
                const bool parallel = frame.camera.orthographic;
                const glm::dvec2 across = projection.plane(screen) * (parallel ? 1 : z);
                const glm::dvec3 place(to_world * glm::dvec4(across, -z, 1));
                const glm::dvec3 line = parallel ? glm::dvec3(0, 0, -z) : glm::dvec3(across, -z);
                points_[static_cast<std::size_t>(y) * width + x] =
                    surface_at(place, glm::dmat3(to_world) * line);
            }
        }
    }

    /// The surface at `place`, seen along `line` from its beginning there. Depth is drawn in float32 and on a grid of
    /// 1/256 pixel, so the triangle is looked for a little before and behind. None found: a normal of 0.
    SurfacePoint surface_at(glm::dvec3 place, glm::dvec3 line) const {
        constexpr double slack = 0.002;
        const auto hit = rays_.hit(place - slack * line, glm::normalize(line), 2 * slack * glm::length(line));
        if (!hit) return {};
        const glm::dvec3 found = place - slack * line + hit->distance * glm::normalize(line);
        // Rays are float32: off the surface by some of the steps that places have there.
        constexpr double steps = 32 * 0x1p-24;
        return {found + steps * (glm::length(line) + glm::length(found)) * hit->normal, hit->normal};
    }

    /// 1, or less by the weight of a surface that the ray meets: 1 at first, falling to 0 over the last part of the
    /// radius.
    double visibility(std::size_t pixel, int index) const {
        const SurfacePoint& point = points_[pixel];
        if (point.normal == glm::dvec3(0)) return 1;
        const glm::dvec2 square = truth_point(index, mix_bits(static_cast<std::uint32_t>(pixel)));
        const auto hit = rays_.hit(point.position, cosine_direction(point.normal, square), radius_);
        if (!hit || hit->distance >= radius_) return 1;
        return falloff_ > 0 ? 1 - std::min(1.0, (radius_ - hit->distance) / (radius_ * falloff_)) : 0;
    }

    SceneRays rays_;
    double radius_, falloff_;
    std::vector<SurfacePoint> points_;
    OccludedLight light_;
};

const RegisterTruth<OcclusionRays> registered("ssao", "scene", "rays against the scene's triangles", 1024);

} // namespace
} // namespace postfx::host
