// Rim light: of the normals that the effect is given in closed form, of the scene's surfaces by rays; and how far a
// method is from the truth on a sphere.
#include "rim_share.hpp"

#include <image/rows.hpp>
#include <truths/closed_form.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/metric.hpp>
#include <truths/sampling.hpp>
#include <truths/scene_rays.hpp>
#include <truths/view_rays.hpp>

#include <fmt/format.h>

#include <limits>
#include <numbers>

namespace postfx::host {
namespace {

RimShare rim_share(const TruthRequest& request) {
    return {.mirrors = request.value("profile") != 0,
            .width = request.value("width"),
            .refractive_index = request.value("refractive_index")};
}

/// The picture that the light is added to, and the light.
class AddedLight {
public:
    AddedLight(const TruthRequest& request, const SceneFrame& frame)
        : color_(given_light(request, frame)), strength_(request.value("strength")),
          light_(request.color("color")) {}

    /// No light is lifted over the largest half float.
    template<class Number>
    std::array<Number, 3> pixel(int x, int y, Number share) const {
        std::array<Number, 3> result;
        for (std::size_t c = 0; c < 3; ++c) {
            const Number color = Number(color_.pixel(x, y)[c]);
            const Number added = share * Number(strength_) * Number(light_[c]);
            result[c] = color + std::min(added, std::max(Number(65504) - color, Number(0)));
        }
        return result;
    }

private:
    Image64 color_;
    double strength_;
    std::array<double, 3> light_;
};

/// Of the attachment of normals.
class RimOfNormals {
public:
    explicit RimOfNormals(const TruthRequest& request)
        : RimOfNormals(request, SceneRenderer(request.scene, {.samples = request.scene_samples})) {}

    template<class Number>
    std::array<Number, 3> pixel(int x, int y) const {
        const float* n = normal_.pixel(x, y);
        const Number length = std::hypot(Number(n[0]), Number(n[1]), Number(n[2]));
        if (length == 0) return light_.pixel<Number>(x, y, 0);
        const Number right = per_pixel_ * (Number(2 * x + 1) - Number(axis_.x));
        const Number up = per_pixel_ * (Number(2 * y + 1) - Number(axis_.y));
        const Number cosine = (Number(n[2]) - right * Number(n[0]) - up * Number(n[1]))
                              / (length * std::hypot(Number(1), right, up));
        return light_.pixel<Number>(x, y, share_.at(cosine));
    }

private:
    RimOfNormals(const TruthRequest& request, SceneRenderer renderer)
        : RimOfNormals(request,
                       renderer.render(request.width, request.height, request.time, {"color", "normal"})) {}
    RimOfNormals(const TruthRequest& request, const SceneFrame& frame)
        : share_(rim_share(request)), light_(request, frame),
          normal_(read_attachment(frame, "normal", request.width, request.height)),
          per_pixel_(frame.camera.tan_half_fov() / request.height),
          axis_(request.width * (1 + frame.camera.principal_point[0]),
                request.height * (1 + frame.camera.principal_point[1])) {}

    RimShare share_;
    AddedLight light_;
    Image normal_;
    double per_pixel_; ///< slope of a ray for half a pixel; 0 for parallel ones
    glm::dvec2 axis_;  ///< where the optical axis is in the picture, half pixels
};

/// Of the scene's surfaces, all over each pixel.
class RimOfSurfaces : public Truth {
public:
    explicit RimOfSurfaces(const TruthRequest& request)
        : RimOfSurfaces(request, SceneRenderer(request.scene, {.samples = request.scene_samples})) {}

    std::string description(int samples) const override {
        return fmt::format("{} rays per pixel, all over it, against the scene's triangles with the normals "
                           "between their corners, without the bumps of textures",
                           samples);
    }
    std::string values() const override {
        return fmt::format("{} width {}, index {}", share_.mirrors ? "fresnel" : "ramp", share_.width,
                           share_.refractive_index);
    }
    int channels() const override { return 1; }

    void add(int index, Image64& sum) override {
        for_each_row(sum.height, [&](int y) {
            for (int x = 0; x < sum.width; ++x) {
                const auto pixel = static_cast<std::uint32_t>(y * sum.width + x);
                const glm::dvec2 place = glm::dvec2(x, y) + truth_point(index, mix_bits(pixel));
                sum.at(x, y, 0) += seen(view_rays_.through(place.x, place.y));
            }
        });
    }

    Image64 picture(const Image64& sum, int count) const override {
        Image64 result(sum.width, sum.height, 3);
        for (int y = 0; y < sum.height; ++y) {
            for (int x = 0; x < sum.width; ++x) {
                const auto color = light_.pixel<double>(x, y, sum.at(x, y, 0) / count);
                std::copy(color.begin(), color.end(), result.pixel(x, y));
            }
        }
        return result;
    }

private:
    RimOfSurfaces(const TruthRequest& request, SceneRenderer renderer)
        : RimOfSurfaces(request, renderer.render(request.width, request.height, request.time, {"color"})) {}
    RimOfSurfaces(const TruthRequest& request, const SceneFrame& frame)
        : share_(rim_share(request)), rays_(request.scene, request.time), light_(request, frame),
          view_rays_(frame.camera, request.width, request.height), near_(frame.camera.near_plane) {}

    double seen(const ViewRay& ray) const {
        const glm::dvec3 begin = ray.origin + ray.length_to(near_) * ray.direction;
        const auto hit = rays_.hit(begin, ray.direction, std::numeric_limits<float>::infinity());
        return hit ? share_.at(glm::dot(rays_.shading_normal(*hit), ray.direction)) : 0;
    }

    RimShare share_;
    SceneRays rays_;
    AddedLight light_;
    ViewRays view_rays_;
    double near_;
};

// ---- on a sphere of parallel rays

constexpr int sphere_size = 256;
constexpr double sphere_radius = 120; ///< pixels

/// Of a pixel's middle, from the sphere's, as a share of its radius; 1 or more outside.
glm::dvec2 on_sphere(int x, int y) {
    return (glm::dvec2(x, y) + 0.5 - 0.5 * sphere_size) / sphere_radius;
}

MethodInput sphere() {
    MethodInput input{.color = Image(sphere_size, sphere_size, 3),
                      .camera = Camera::parallel(sphere_size / sphere_radius, 0.1, 10)};
    Image depth(sphere_size, sphere_size, 1, static_cast<float>(input.camera.sky_depth));
    Image normal(sphere_size, sphere_size, 3);
    for (int y = 0; y < sphere_size; ++y) {
        for (int x = 0; x < sphere_size; ++x) {
            const glm::dvec2 place = on_sphere(x, y);
            const double squared = glm::dot(place, place);
            if (squared >= 1) continue;
            const double cosine = std::sqrt(1 - squared);
            depth.at(x, y, 0) = static_cast<float>(input.camera.depth_at(3 - cosine));
            normal.at(x, y, 0) = static_cast<float>(place.x);
            normal.at(x, y, 1) = static_cast<float>(place.y);
            normal.at(x, y, 2) = static_cast<float>(cosine);
        }
    }
    input.attachments = {{"depth", depth}, {"normal", normal}};
    return input;
}

Image64 drawn_sphere(const Method& method, const RimShare& share) {
    const ChainEntry entry = entry_with(method, {{"strength", 1},
                                                 {"color", 1},
                                                 {"profile", share.mirrors ? 1 : 0},
                                                 {"width", share.width},
                                                 {"refractive_index", share.refractive_index}});
    return method.draw(entry, sphere());
}

/// Both profiles; the pixels that the sphere covers.
double sphere_error(const Method& method) {
    double worst = 0;
    for (const RimShare share : {RimShare{}, RimShare{.mirrors = true}}) {
        const Image64 result = drawn_sphere(method, share);
        for (int y = 0; y < sphere_size; ++y) {
            for (int x = 0; x < sphere_size; ++x) {
                const glm::dvec2 place = on_sphere(x, y);
                const double squared = glm::dot(place, place);
                if (squared >= 1) continue;
                const double expected = share.at(std::sqrt(1 - squared));
                worst = std::max(worst, std::abs(result.at(x, y, 0) - expected));
            }
        }
    }
    return worst;
}

/// Of a ramp, over a sphere's disc: width^2 / 3 up to a width of 1, 1 - 2 / (3 width) from there on.
double mean_error(const Method& method) {
    double worst = 0;
    for (const double width : {0.25, 0.5, 1.0, 2.0}) {
        const Image64 result = drawn_sphere(method, {.width = width});
        double sum = 0;
        for (int y = 0; y < sphere_size; ++y) {
            for (int x = 0; x < sphere_size; ++x)
                sum += result.at(x, y, 0);
        }
        const double mean = sum / (std::numbers::pi * sphere_radius * sphere_radius);
        const double expected = width <= 1 ? width * width / 3 : 1 - 2 / (3 * width);
        worst = std::max(worst, std::abs(mean - expected));
    }
    return worst;
}

const RegisterTruth<ClosedForm<RimOfNormals>> registered_layer("rim_light", "layer",
                                                               "its model at each pixel's normal", 2);
const RegisterTruth<RimOfSurfaces> registered_scene("rim_light", "scene",
                                                    "the mean over each pixel of the scene's surfaces", 256);
const RegisterMetric registered_error("rim_light", "sphere_error", "",
                                      "largest error of the rim's share on a sphere, both profiles",
                                      sphere_error);
const RegisterMetric registered_mean("rim_light", "mean_error", "",
                                     "largest error of a ramp's mean over a sphere, which is known",
                                     mean_error);

} // namespace
} // namespace postfx::host
