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
    glm::dvec2 middle{0};            ///< of the picture, from where the view axis is in it, in half extents

    /// Where the ray of `screen` (-1..1) crosses the plane 1 m before the eye, or how far it is beside the view axis.
    glm::dvec2 plane(glm::dvec2 screen) const { return half_extent * (screen + middle); }
};

/// For clip space with z from 0 to 1. `shift`: see CameraOverride; it comes on top of the camera's own.
Projection make_projection(const Camera& camera, double aspect, glm::dvec2 shift = glm::dvec2(0));

/// The same camera in the depth convention in which scenes are drawn.
Camera drawable(const Camera& camera);

/// Is the box wholly outside of one side of the view?
bool outside(const glm::dmat4& world_to_clip, const Bounds& bounds);

} // namespace postfx::host
