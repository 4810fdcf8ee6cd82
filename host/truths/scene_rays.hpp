// Rays against a scene's triangles.
#pragma once

#include <scene/scene.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>

namespace postfx::host {

/// The opaque surfaces of a scene at one time, in world space. Blended ones are left out, as they are in depth; a
/// surface with holes in its texture counts as whole.
class SceneRays {
public:
    SceneRays(const Scene& scene, double time);
    ~SceneRays();
    SceneRays(const SceneRays&) = delete;
    SceneRays& operator=(const SceneRays&) = delete;

    struct Hit {
        double distance = 0;  ///< metres
        glm::dvec3 normal{0}; ///< of the triangle, unit, towards where the ray came from
        std::uint32_t mesh = 0, triangle = 0;
        glm::dvec2 within{0}; ///< weights of the triangle's second and third corner
    };
    /// The first surface, front or back, up to `reach` metres. `direction` is unit. Several threads may ask.
    std::optional<Hit> hit(glm::dvec3 origin, glm::dvec3 direction, double reach) const;

    /// The one that is shaded there, without the bumps of textures: between those of the triangle's corners. World space,
    /// unit, on the surface's front whichever side was met.
    glm::dvec3 shading_normal(const Hit& hit) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace postfx::host
