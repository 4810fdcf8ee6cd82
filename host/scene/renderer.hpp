// Draws a scene into textures: colour, depth and what else is wanted. [GL thread]
#pragma once

#include "scene.hpp"

#include <postfx/camera.hpp>
#include <postfx/format.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

/// A camera of the host's own instead of the scene's. `shift` moves the picture's middle sideways by that
/// many of its half extents without turning the camera, as a shifted lens does: a lens sampled at many points
/// needs it.
struct CameraOverride {
    Camera camera; ///< any projection; drawn with reversed depth, infinite far plane when it is perspective
    glm::dvec2 shift{0};
};

/// One texture of a frame; it belongs to the renderer and is overwritten by the next.
struct SceneAttachment {
    std::string name;
    std::uint32_t texture = 0; ///< GL name
    Format format = Format::rgba16f;
};

struct SceneFrame {
    std::vector<SceneAttachment> attachments; ///< "color", "depth", then the others that were wanted
    Camera camera;                            ///< as drawn
    std::size_t texture_bytes = 0;            ///< of what was drawn into, samples included
    std::size_t draws = 0, triangles = 0;     ///< of the picture, without shadow maps

    /// 0 when there is none of that name.
    std::uint32_t texture(const std::string& name) const;
};

struct SceneRendererOptions {
    /// Per pixel, 1 or 4. Four smooth the edges; a software rasterizer takes four times as long for them.
    int samples = 1;
};

class SceneRenderer {
public:
    /// Uploads everything. Needs a current OpenGL 4.5 context for its whole life.
    explicit SceneRenderer(Scene scene, SceneRendererOptions options = {});
    ~SceneRenderer();
    SceneRenderer(SceneRenderer&&) noexcept;
    SceneRenderer& operator=(SceneRenderer&&) noexcept;

    /// Draw the scene as it is at `time` seconds. `wanted`: any of "color" (always made), "depth" (made too where
    /// it costs nothing: with one sample per pixel), "normal" (view space, unit, of opaque surfaces), "emission",
    /// "ambient" (the share of the light in color that occlusion may darken); what is not wanted is not drawn.
    /// Colours are scene-linear rgba16f, depth is 32F, near / z, exactly 0 where nothing is. Makes GL objects only
    /// when size or wanted have changed. Throws Error.
    SceneFrame render(int width, int height, double time, const std::vector<std::string>& wanted,
                      const std::optional<CameraOverride>& camera = std::nullopt);

    const Scene& scene() const;

    /// Of what can be wanted (all known_attachments), by name.
    static std::map<std::string, Format> attachment_formats();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace postfx::host
