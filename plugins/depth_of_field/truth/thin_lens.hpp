// The lens that a depth of field effect's values describe, in front of a perspective camera.
#pragma once

#include <truths/truth.hpp>

#include <glm/glm.hpp>

#include <array>
#include <string>

namespace postfx::host {

struct ThinLens {
    double aperture = 0; ///< diameter, metres
    /// 1 / distance [1/m] of the plane that is sharp, for red, green and blue.
    std::array<double, 3> focus{};
    glm::dvec2 half_extent{1}; ///< tan of half the field of view, across and up

    bool achromatic() const { return focus[0] == focus[1] && focus[1] == focus[2]; }
    /// All of it, as text.
    std::string text() const;
};

/// Throws Error for an orthographic camera, through which no lens looks, and for a view that is not the picture.
ThinLens thin_lens(const TruthRequest& request, const Camera& camera);

/// Sample `index` as a point of the lens, in its unit disc.
glm::dvec2 lens_point(int index);

} // namespace postfx::host
