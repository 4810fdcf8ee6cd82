// The ray of each place in a picture.
#pragma once

#include <scene/projection.hpp>

#include <postfx/camera.hpp>

#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace postfx::host {

/// In world space, from the eye, or from the near plane for parallel rays.
struct ViewRay {
    glm::dvec3 origin{0}, direction{0, 0, -1}; ///< metres; unit
    double begin = 0;                          ///< of the ray along the view axis [m]
    double per_metre = 1;                      ///< length of the ray for each metre along the view axis

    /// Metres from the origin to what is `view_z` metres away along the view axis.
    double length_to(double view_z) const { return (view_z - begin) * per_metre; }
};

class ViewRays {
public:
    ViewRays(const Camera& camera, int width, int height)
        : parallel_(camera.orthographic), near_(camera.near_plane), size_(width, height),
          projection_(make_projection(camera, static_cast<double>(width) / height)),
          to_world_(glm::make_mat4(camera.view_to_world.data())) {}

    /// Pixels from the picture's lower left corner.
    ViewRay through(double x, double y) const {
        const glm::dvec2 across = projection_.plane(2.0 * glm::dvec2(x, y) / size_ - 1.0);
        if (parallel_) {
            return {.origin = glm::dvec3(to_world_ * glm::dvec4(across, -near_, 1)),
                    .direction = -glm::normalize(glm::dvec3(to_world_[2])),
                    .begin = near_};
        }
        const glm::dvec3 line(across, -1);
        return {.origin = glm::dvec3(to_world_[3]),
                .direction = glm::normalize(glm::dmat3(to_world_) * line),
                .per_metre = glm::length(line)};
    }

private:
    bool parallel_;
    double near_;
    glm::dvec2 size_;
    Projection projection_;
    glm::dmat4 to_world_;
};

} // namespace postfx::host
