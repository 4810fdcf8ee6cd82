// A scene's meshes, materials and textures on the GPU, made once. [GL thread]
#pragma once

#include "scene.hpp"

#include <gl/objects.hpp>

#include <map>
#include <vector>

namespace postfx::host {

/// One part of the scene, ready to draw.
struct DrawPart {
    std::size_t node = 0, material = 0;
    Bounds bounds; ///< in the node's space
    GLsizei index_count = 0;
    std::size_t first_index = 0; ///< bytes
    GLint base_vertex = 0;
};

class SceneBuffers {
public:
    explicit SceneBuffers(const Scene& scene);

    const std::vector<DrawPart>& parts() const { return parts_; }
    GLuint vertex_array() const { return vertex_array_.name(); }
    /// Bind the material's block (binding 1) and, if it has textures, those (units 0 to 3).
    void bind_material(std::size_t material) const;

private:
    using TextureHandle = gl::Handle<gl::destroy_texture>;

    void upload_meshes(const Scene& scene);
    void upload_materials(const Scene& scene);
    GLuint texture_of(const PicturePtr& picture);

    std::vector<DrawPart> parts_;
    gl::Buffer vertices_, indices_, materials_;
    gl::VertexArray vertex_array_;
    std::size_t material_stride_ = 0;
    struct Textures {
        bool any = false;
        GLuint names[4] = {};
    };
    std::vector<Textures> textures_of_material_;
    std::map<PicturePtr, TextureHandle> textures_;
    TextureHandle white_;
};

} // namespace postfx::host
