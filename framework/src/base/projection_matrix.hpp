// A camera from the projection matrix that a picture was drawn with.
#pragma once

#include <postfx/camera.hpp>

#include <array>
#include <optional>

namespace postfx {

/// OpenGL's, column by column: clip = matrix * view position, the camera looks down -z. Any multiple of it is the same
/// projection.
using ProjectionMatrix = std::array<double, 16>;

/// Field of view (or extent) and principal point of a perspective or parallel view of that many pixels; with `kind`
/// also near plane, far plane and depth numbers, of clip depth -1..1 (standard) or 0..1 (the reversed kinds). Without,
/// the depth rows are not looked at: near, far and depth numbers are the defaults.
/// Throws Error that says what is wrong: numbers that are not finite, rows for columns, a camera that looks along +z, a
/// mirrored picture, sheared or turned axes, a picture of another shape (by more than 1 %), depth that runs the other
/// way or begins behind the camera.
Camera camera_of(const ProjectionMatrix& matrix, std::optional<Camera::DepthKind> kind, int width,
                 int height);

} // namespace postfx
