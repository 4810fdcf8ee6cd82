#include "projection.hpp"

#include <array>
#include <cmath>

namespace postfx::host {

Projection make_projection(const Camera& camera, double aspect, glm::dvec2 shift) {
    const double half = camera.orthographic ? camera.vertical_extent / 2 : camera.tan_half_fov();
    Projection result;
    result.half_extent = {half * aspect, half};
    result.middle = shift - glm::dvec2(camera.principal_point[0], camera.principal_point[1]);
    const glm::dvec2 h = result.half_extent, middle = result.middle;
    glm::dmat4& m = result.view_to_clip; // m[column][row]
    m = glm::dmat4(0);
    m[0][0] = 1 / h.x;
    m[1][1] = 1 / h.y;
    if (camera.orthographic) {
        const double depth = camera.far_plane - camera.near_plane;
        m[2][2] = 1 / depth;
        m[3][2] = camera.far_plane / depth;
        m[3][0] = -middle.x;
        m[3][1] = -middle.y;
        m[3][3] = 1;
        result.clip_to_direction = glm::dmat4(0);
        result.clip_to_direction[2] = {0, 0, -1, 0};
    } else {
        m[2][0] = middle.x;
        m[2][1] = middle.y;
        m[2][3] = -1;
        m[3][2] = camera.near_plane;
        result.clip_to_direction = glm::dmat4(0);
        result.clip_to_direction[0][0] = h.x;
        result.clip_to_direction[1][1] = h.y;
        result.clip_to_direction[2] = {h.x * middle.x, h.y * middle.y, -1, 0};
    }
    return result;
}

Camera drawable(const Camera& camera) {
    Camera result = camera.orthographic
                        ? Camera::parallel(camera.vertical_extent, camera.near_plane, camera.far_plane)
                        : Camera::perspective(camera.vertical_fov, camera.near_plane);
    result.principal_point = camera.principal_point;
    result.view_to_world = camera.view_to_world;
    return result;
}

bool outside(const glm::dmat4& world_to_clip, const Bounds& bounds) {
    std::array<int, 5>
        beyond{}; // left, right, bottom, top, before the near plane; far is infinite or rarely helps
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point(corner & 1 ? bounds.high.x : bounds.low.x,
                               corner & 2 ? bounds.high.y : bounds.low.y,
                               corner & 4 ? bounds.high.z : bounds.low.z);
        const glm::dvec4 clip = world_to_clip * glm::dvec4(point, 1);
        beyond[0] += clip.x < -clip.w;
        beyond[1] += clip.x > clip.w;
        beyond[2] += clip.y < -clip.w;
        beyond[3] += clip.y > clip.w;
        beyond[4] += clip.z > clip.w;
    }
    for (const int count : beyond) {
        if (count == 8) return true;
    }
    return false;
}

} // namespace postfx::host
