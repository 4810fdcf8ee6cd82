// Fog in float64: closed forms of the integral of density along the ray, from world positions.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace postfx::testing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Vector = std::array<double, 3>;

double world_height(const Camera& camera, const Vector& view) {
    const auto& m = camera.view_to_world; // m[4 * column + row]
    return m[1] * view[0] + m[5] * view[1] + m[9] * view[2] + m[13];
}

struct Ray {
    double beginning, slope, length; ///< height [m], its gain per metre, metres (infinite to the sky)
};

Ray ray_of(const ReferenceInput& input, int x, int y) {
    const Camera& camera = input.camera;
    const double half_height = camera.orthographic ? camera.vertical_extent / 2 : camera.tan_half_fov();
    const auto& [axis_right, axis_up] = camera.principal_point;
    const int width = input.color.width, height = input.color.height;
    const double across = (2 * x + 1.0 - width - axis_right * width) / height * half_height;
    const double up = (2 * y + 1.0 - height - axis_up * height) / height * half_height;
    const double z = camera.view_z(input.attachments.at("depth").at(x, y, 0));
    const double begin = camera.orthographic ? camera.near_plane : 0;
    const Vector from = camera.orthographic ? Vector{across, up, -begin} : Vector{0, 0, 0};
    const Vector to = camera.orthographic ? Vector{across, up, -begin - 1} : Vector{across, up, -1};
    const double per_view_distance = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    const double begin_height = world_height(camera, from);
    return {begin_height, (world_height(camera, to) - begin_height) / per_view_distance,
            (z - begin) * per_view_distance};
}

double height_fog_thickness(const ReferenceInput& input, const Ray& ray) {
    const double falloff = input.value("height_falloff"), start = input.value("start");
    if (ray.length <= start) return 0;
    const double height = ray.beginning + ray.slope * start - input.value("base_height");
    const double density = input.value("density") * std::exp(-falloff * height);
    const double per_metre = falloff * ray.slope, length = ray.length - start;
    if (per_metre == 0) return density * length;
    if (std::isinf(length)) return per_metre > 0 ? density / per_metre : infinity;
    return density * -std::expm1(-per_metre * length) / per_metre;
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const bool classic = input.level == "classic";
    const Image64& depth = input.attachments.at("depth");
    Image64 result(input.color.width, input.color.height, 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const double z = input.camera.view_z(depth.at(x, y, 0));
            const double begin = input.camera.orthographic ? input.camera.near_plane : 0;
            const double clear = begin + input.value("start");
            double thickness = classic ? input.value("density") * std::max(z - clear, 0.0)
                                       : height_fog_thickness(input, ray_of(input, x, y));
            if (std::isinf(z) && input.value("sky") == 0) thickness = 0;
            const double opacity = std::min(-std::expm1(-thickness), input.value("max_opacity"));
            const double kept = std::max(std::exp(-thickness), 1 - input.value("max_opacity"));
            const double light[] = {input.value("color.0"), input.value("color.1"), input.value("color.2")};
            for (int c = 0; c < 3; ++c)
                result.at(x, y, c) = kept * input.color.at(x, y, c) + opacity * light[c];
        }
    }
    return result;
}

} // namespace postfx::testing
