// How far fog's transmittance is from what quadrature says.
#include "fog_path.hpp"

#include <truths/metric.hpp>
#include <truths/view_rays.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// Rays of many slopes, one row of them level, with surfaces from 0.1 m to 100 km; from that height of the eye.
MethodInput sweep(double eye_height) {
    constexpr int width = 128, height = 63;
    MethodInput input{.color = Image(width, height, 3, 1), .camera = Camera::perspective(90, 0.05)};
    input.camera.view_to_world[13] = eye_height;
    Image depth(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double z = 0.1 * std::pow(1e6, (x + 0.5) / width);
            depth.at(x, y, 0) = static_cast<float>(input.camera.depth_at(z));
        }
    }
    input.attachments = {{"depth", depth}};
    return input;
}

double transmittance_error(const Method& method) {
    constexpr double density = 0.02;
    double worst = 0;
    for (const double eye_height : {0.0, 2.0, 300.0, -20.0}) {
        const MethodInput input = sweep(eye_height);
        const Image& depth = input.attachments.at("depth");
        const ViewRays rays(input.camera, depth.width, depth.height);
        for (const double falloff : {0.0, 1e-4, 0.04, 0.5}) {
            const ChainEntry entry = entry_with(method, {{"density", density},
                                                         {"height_falloff", falloff},
                                                         {"base_height", 0},
                                                         {"color", 0},
                                                         {"start", 0},
                                                         {"max_opacity", 1}});
            const Image64 result = method.draw(entry, input);
            for (int y = 0; y < depth.height; ++y) {
                for (int x = 0; x < depth.width; ++x) {
                    const ViewRay ray = rays.through(x + 0.5, y + 0.5);
                    const FogPath path{.density = density,
                                       .falloff = falloff,
                                       .height = ray.origin.y,
                                       .rise = ray.direction.y,
                                       .length = ray.length_to(input.camera.view_z(depth.at(x, y, 0)))};
                    const double expected = fog_by_thickness(path).transmittance;
                    worst = std::max(worst, std::abs(result.at(x, y, 0) - expected));
                }
            }
        }
    }
    return worst;
}

const RegisterMetric registered("fog", "transmittance_error", "",
                                "largest error of the light that comes through, 0.1 m to 100 km, any slope",
                                transmittance_error);

} // namespace
} // namespace postfx::host
