#include "scene_buffers.hpp"

#include "view_block.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace postfx::host {
namespace {

gl::Handle<gl::destroy_texture> upload(const Picture& picture) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    gl::Handle<gl::destroy_texture> texture(name);
    const auto largest = static_cast<unsigned>(std::max(picture.width, picture.height));
    glTextureStorage2D(name, static_cast<GLsizei>(std::bit_width(largest)),
                       picture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, picture.width, picture.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(name, 0, 0, 0, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                        picture.rgba.data());
    glGenerateTextureMipmap(name);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture;
}

} // namespace

SceneBuffers::SceneBuffers(const Scene& scene) : white_(upload({1, 1, {255, 255, 255, 255}, false})) {
    upload_meshes(scene);
    upload_materials(scene);
}

void SceneBuffers::upload_meshes(const Scene& scene) {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::map<const Mesh*, DrawPart> uploaded; // a model that stands in several nodes is stored once
    for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
        for (const Part& part : scene.nodes[node].parts) {
            const auto [entry, added] = uploaded.try_emplace(part.mesh.get());
            DrawPart& draw = entry->second;
            if (added) {
                draw.bounds = part.mesh->bounds();
                draw.index_count = static_cast<GLsizei>(part.mesh->indices.size());
                draw.first_index = indices.size() * sizeof(std::uint32_t);
                draw.base_vertex = static_cast<GLint>(vertices.size());
                vertices.insert(vertices.end(), part.mesh->vertices.begin(), part.mesh->vertices.end());
                indices.insert(indices.end(), part.mesh->indices.begin(), part.mesh->indices.end());
            }
            draw.node = node;
            draw.material = part.material;
            if (draw.index_count > 0) parts_.push_back(draw);
        }
    }
    vertex_array_ = gl::make_vertex_array();
    if (parts_.empty()) return;
    vertices_ = gl::make_buffer(vertices.size() * sizeof(Vertex), vertices.data(), 0);
    indices_ = gl::make_buffer(indices.size() * sizeof(std::uint32_t), indices.data(), 0);

    const GLuint array = vertex_array_.name();
    glVertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array, indices_.name());
    const auto attribute = [&](GLuint location, GLint size, std::size_t offset) {
        glEnableVertexArrayAttrib(array, location);
        glVertexArrayAttribFormat(array, location, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
        glVertexArrayAttribBinding(array, location, 0);
    };
    attribute(0, 3, offsetof(Vertex, position));
    attribute(1, 3, offsetof(Vertex, normal));
    attribute(2, 2, offsetof(Vertex, uv));
    attribute(3, 3, offsetof(Vertex, tint));
}

void SceneBuffers::upload_materials(const Scene& scene) {
    GLint alignment = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    const auto step = static_cast<std::size_t>(alignment);
    material_stride_ = (sizeof(MaterialBlock) + step - 1) / step * step;
    std::vector<std::byte> bytes(material_stride_ * std::max<std::size_t>(scene.materials.size(), 1));
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const MaterialBlock block{glm::vec4(material.diffuse, material.opacity),
                                  glm::vec4(material.specular, material.shininess),
                                  glm::vec4(material.emission, material.alpha_cutoff),
                                  {material.normal_texture ? 1 : 0, material.metal_roughness_texture ? 1 : 0,
                                   material.blended ? 1 : 0, 0}};
        std::memcpy(bytes.data() + i * material_stride_, &block, sizeof block);
        textures_of_material_.push_back(
            {material.textured(),
             {texture_of(material.diffuse_texture), texture_of(material.emission_texture),
              texture_of(material.normal_texture), texture_of(material.metal_roughness_texture)}});
    }
    materials_ = gl::make_buffer(bytes.size(), bytes.data(), 0);
}

GLuint SceneBuffers::texture_of(const PicturePtr& picture) {
    if (!picture) return white_.name();
    auto& texture = textures_[picture];
    if (!texture) texture = upload(*picture);
    return texture.name();
}

void SceneBuffers::bind_material(std::size_t material) const {
    glBindBufferRange(GL_UNIFORM_BUFFER, 1, materials_.name(),
                      static_cast<GLintptr>(material * material_stride_), sizeof(MaterialBlock));
    const Textures& textures = textures_of_material_[material];
    if (textures.any) glBindTextures(0, 4, textures.names);
}

} // namespace postfx::host
