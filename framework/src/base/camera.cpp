#include <postfx/camera.hpp>

#include <cmath>
#include <numbers>

namespace postfx {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

Camera Camera::perspective(double vertical_fov_degrees, double near_plane, double far_plane, DepthKind kind) {
    Camera camera;
    camera.vertical_fov = vertical_fov_degrees;
    camera.near_plane = near_plane;
    camera.far_plane = kind == DepthKind::reversed_infinite ? infinity : far_plane;
    const double inverse_near = 1 / near_plane;
    const double inverse_far = 1 / camera.far_plane; // 0 for an infinite far plane
    if (kind == DepthKind::standard) {
        camera.depth_scale = inverse_far - inverse_near;
        camera.depth_offset = inverse_near;
        camera.sky_depth = 1;
    } else {
        camera.depth_scale = inverse_near - inverse_far;
        camera.depth_offset = inverse_far;
        camera.sky_depth = 0;
    }
    return camera;
}

Camera Camera::parallel(double vertical_extent, double near_plane, double far_plane, DepthKind kind) {
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = vertical_extent;
    camera.near_plane = near_plane;
    camera.far_plane = far_plane;
    const bool standard = kind == DepthKind::standard;
    camera.depth_scale = standard ? far_plane - near_plane : near_plane - far_plane;
    camera.depth_offset = standard ? near_plane : far_plane;
    camera.sky_depth = standard ? 1 : 0;
    return camera;
}

double Camera::view_z(double depth) const {
    if (depth == sky_depth) return infinity;
    const double affine = depth_scale * depth + depth_offset;
    return orthographic ? affine : 1 / affine;
}

double Camera::depth_at(double view_z) const {
    if (std::isinf(view_z)) return sky_depth;
    return ((orthographic ? view_z : 1 / view_z) - depth_offset) / depth_scale;
}

double Camera::tan_half_fov() const {
    return orthographic ? 0 : std::tan(vertical_fov * std::numbers::pi / 360);
}

std::array<double, 2> Camera::view_plane(double x, double y, int width, int height) const {
    const double half_height = orthographic ? vertical_extent / 2 : tan_half_fov();
    const double half_width = half_height * width / height;
    return {(2 * x / width - 1 - principal_point[0]) * half_width,
            (2 * y / height - 1 - principal_point[1]) * half_height};
}

} // namespace postfx
