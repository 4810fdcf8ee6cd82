// A scene's meshes, materials and textures on the GPU, made once. [GL thread]
#pragma once

#include "scene.hpp"
#include "view_block.hpp"

#include <gl/objects.hpp>

#include <map>
#include <vector>

namespace postfx::host {

/// One part of the scene, ready to draw.
struct DrawPart {
    std::size_t node = 0, material = 0;
    const Mesh* mesh = nullptr; ///< the scene's
    Bounds bounds;              ///< in the node's space
    GLsizei index_count = 0;
    std::size_t first_index = 0; ///< bytes
    GLint base_vertex = 0;
};

class SceneBuffers {
public:
    explicit SceneBuffers(const Scene& scene);

    /// Bring meshes that change their shape to that time; `nodes` as placed then.
    void deform(const Scene& scene, const std::vector<glm::dmat4>& nodes, double time);

    const std::vector<DrawPart>& parts() const { return parts_; }
    GLuint vertex_array() const { return vertex_array_.name(); }
    /// Bind the material's block (binding 1) and, if it has textures, those (units 0 to 3 and 5).
    void bind_material(std::size_t material) const;
    /// After the last material: textures have their own filters again.
    static void unbind_samplers();

private:
    using TextureHandle = gl::Handle<gl::destroy_texture>;

    /// Vertices, indices and what else goes into the buffers.
    struct Streams;
    void upload_meshes(const Scene& scene);
    DrawPart store(const Mesh& mesh, Streams& streams) const;
    void make_arrays(const Streams& streams);
    void upload_materials(const Scene& scene);
    GLuint texture_of(const Texture& texture);
    GLuint sampler_of(const Texture& texture);

    std::vector<DrawPart> parts_;
    gl::Buffer vertices_, extras_, indices_, materials_;
    gl::VertexArray vertex_array_;
    std::size_t material_stride_ = 0;
    struct Textures {
        bool any = false;
        GLuint names[material_textures] = {}, samplers[material_textures] = {};
    };
    std::vector<Textures> textures_of_material_;
    std::map<PicturePtr, TextureHandle> textures_;
    std::map<Sampler, gl::Sampler> samplers_;
    std::vector<Vertex> deformed_; ///< kept so that steady frames allocate nothing
    TextureHandle white_;
};

} // namespace postfx::host
