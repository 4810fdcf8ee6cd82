// Normals that somebody else made, brought to what effects want: unit vectors in view space.
#pragma once

#include <image/files.hpp>

#include <postfx/camera.hpp>
#include <postfx/image.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

/// World to camera, column by column, for column vectors; the camera looks down -z, x is right and y up.
using RigidMatrix = std::array<double, 16>;

/// What is known of an image of normals.
struct NormalSource {
    std::string name{}; ///< of the file, for messages
    Coding coding{};
    NormalSpace space = NormalSpace::view;
    std::optional<RigidMatrix> world_to_camera{}; ///< needed for NormalSpace::world
};

struct ViewNormals {
    Image image{};                       ///< 3 channels, view space; 0 where nothing is
    std::vector<std::string> warnings{}; ///< what was brought into shape, and what looks wrong, one line each
};

/// `normals`: 3 channels or more. Codes are decoded as 2 n - 1 (black and grey: nothing there). Floats that are codes
/// too, vectors that are not of length 1, and ones of world space are brought into shape, with a line for each. Pixels
/// that are 0 are nothing, and so is what is not finite. Where a quarter of all look away from the camera, which no
/// surface in view does, a line says so. Throws Error when most are no unit vectors by any measure, when there are
/// fewer than 3 channels, and for a matrix that is missing or no turn and move.
ViewNormals view_normals(const Image& normals, const NormalSource& source, const Camera& camera);

} // namespace postfx
