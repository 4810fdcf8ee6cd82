// Depth as the shadow-casting lights see it, one layer each. [GL thread]
#pragma once

#include "scene.hpp"
#include "scene_buffers.hpp"
#include "shader_library.hpp"
#include "view_block.hpp"

#include <gl/objects.hpp>

#include <vector>

namespace postfx::host {

/// Directional and spot lights that cast shadows, the first max_shadows of them. A spot's map spans at most
/// 120 degrees: what is further from its axis counts as lit.
class ShadowMaps {
public:
    explicit ShadowMaps(const Scene& scene);

    /// Draw every map. Expects reversed depth and depth test as the scene has them.
    void draw(const Scene& scene, const std::vector<glm::dmat4>& nodes, const Camera& camera,
              const SceneBuffers& buffers);
    /// Tell the shader where they are, from an eye that is there in the world.
    void describe(ViewBlock& view, glm::dvec3 eye) const;
    /// Every light's kind and layer, in the scene's order.
    std::vector<LightCode> light_codes(const Scene& scene) const;
    GLuint texture() const { return texture_.name(); }

private:
    struct Map {
        std::size_t light;
        gl::Framebuffer framebuffer;
        glm::dmat4 world_to_clip{1};
        float texel = 0;    ///< metres at clip w = 1
        float softness = 0; ///< texels
    };
    std::vector<Map> maps_;
    gl::Handle<gl::destroy_texture> texture_;
    gl::Program program_, cut_program_; ///< cut_program_ only if some material is cut
};

} // namespace postfx::host
