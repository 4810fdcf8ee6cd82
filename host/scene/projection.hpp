// Projections with reversed depth (1 at the near plane), and what lies outside of them.
#pragma once

#include "geometry.hpp"

#include <postfx/camera.hpp>

#include <glm/glm.hpp>

namespace postfx::host {

struct Projection {
    glm::dmat4 view_to_clip{1};
    glm::dmat4 clip_to_direction{1}; ///< (x, y, 1, 0), x and y in -1..1, to a direction in view space
    glm::dvec2 half_extent{1};       ///< perspective: tan of half the field of view; orthographic: metres
};

/// For clip space with z from 0 to 1. `shift`: see CameraOverride.
Projection make_projection(const Camera& camera, double aspect, glm::dvec2 shift = glm::dvec2(0));

/// The same camera in the depth convention in which scenes are drawn.
Camera drawable(const Camera& camera);

/// Is the box wholly outside of one side of the view?
bool outside(const glm::dmat4& world_to_clip, const Bounds& bounds);

} // namespace postfx::host
