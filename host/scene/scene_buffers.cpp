#include "scene_buffers.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace postfx::host {
namespace {

gl::Handle<gl::destroy_texture> upload(const Picture& picture) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    gl::Handle<gl::destroy_texture> texture(name);
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (std::max(picture.width, picture.height) > limit) {
        throw Error(fmt::format("a texture has {}x{} pixels, this device has at most {} to a side",
                                picture.width, picture.height, limit));
    }
    const auto largest = static_cast<unsigned>(std::max(picture.width, picture.height));
    glTextureStorage2D(name, static_cast<GLsizei>(std::bit_width(largest)),
                       picture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, picture.width, picture.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(name, 0, 0, 0, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                        picture.rgba.data());
    glGenerateTextureMipmap(name);
    return texture;
}

GLint wrap_of(Sampler::Wrap wrap) {
    switch (wrap) {
    case Sampler::Wrap::clamp:
        return GL_CLAMP_TO_EDGE;
    case Sampler::Wrap::mirror:
        return GL_MIRRORED_REPEAT;
    case Sampler::Wrap::repeat:
        break;
    }
    return GL_REPEAT;
}

GLint minify_of(const Sampler& sampler) {
    const bool linear = sampler.minify == Sampler::Filter::linear;
    switch (sampler.mips) {
    case Sampler::Mips::none:
        return linear ? GL_LINEAR : GL_NEAREST;
    case Sampler::Mips::nearest:
        return linear ? GL_LINEAR_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_NEAREST;
    case Sampler::Mips::linear:
        break;
    }
    return linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_LINEAR;
}

gl::Sampler make(const Sampler& sampler) {
    GLuint name = 0;
    glCreateSamplers(1, &name);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, wrap_of(sampler.wrap_u));
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, wrap_of(sampler.wrap_v));
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, minify_of(sampler));
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER,
                        sampler.magnify == Sampler::Filter::linear ? GL_LINEAR : GL_NEAREST);
    return gl::Sampler(name);
}

/// In the order of the shader's maps.
std::array<const Texture*, material_textures> textures_of(const Material& material) {
    return {&material.diffuse_texture, &material.emission_texture, &material.normal_texture,
            &material.metal_roughness_texture, &material.occlusion_texture};
}

MaterialBlock block_of(const Material& material) {
    MaterialBlock block{.diffuse = glm::vec4(material.diffuse, material.opacity),
                        .specular = glm::vec4(material.specular, material.shininess),
                        .emission = glm::vec4(material.emission, material.alpha_cutoff),
                        .factors = {material.normal_scale, material.occlusion_strength, material.roughness,
                                    material.metalness},
                        .uv_rows = {},
                        .is = {material.blended ? 1 : 0, 0, 0, 0}};
    const auto textures = textures_of(material);
    for (std::size_t i = 0; i < textures.size(); ++i) {
        const glm::mat3x2& placement = textures[i]->placement;
        const auto second = static_cast<float>(textures[i]->uv_set);
        for (int row = 0; row < 2; ++row) {
            block.uv_rows[2 * i + static_cast<std::size_t>(row)] = {placement[0][row], placement[1][row],
                                                                    placement[2][row], second};
        }
    }
    return block;
}

} // namespace

SceneBuffers::SceneBuffers(const Scene& scene) : white_(upload({1, 1, {255, 255, 255, 255}, false})) {
    upload_meshes(scene);
    upload_materials(scene);
}

struct SceneBuffers::Streams {
    std::vector<Vertex> vertices;
    std::vector<VertexExtra> extras;
    std::vector<std::uint32_t> indices;
    bool any_extras = false, any_deformation = false;
};

DrawPart SceneBuffers::store(const Mesh& mesh, Streams& streams) const {
    DrawPart part;
    part.mesh = &mesh;
    part.bounds = mesh.bounds();
    part.index_count = static_cast<GLsizei>(mesh.indices.size());
    part.first_index = streams.indices.size() * sizeof(std::uint32_t);
    part.base_vertex = static_cast<GLint>(streams.vertices.size());
    streams.vertices.insert(streams.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    streams.indices.insert(streams.indices.end(), mesh.indices.begin(), mesh.indices.end());
    streams.extras.insert(streams.extras.end(), mesh.extras.begin(), mesh.extras.end());
    streams.extras.resize(streams.vertices.size());
    streams.any_extras = streams.any_extras || !mesh.extras.empty();
    streams.any_deformation = streams.any_deformation || mesh.deformation;
    return part;
}

void SceneBuffers::upload_meshes(const Scene& scene) {
    Streams streams;
    std::map<const Mesh*, DrawPart> stored; // a model that stands in several nodes is stored once
    for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
        for (const Part& part : scene.nodes[node].parts) {
            DrawPart draw;
            if (part.mesh->deformation) {
                draw = store(*part.mesh, streams); // each node has a shape of its own
            } else {
                const auto [entry, added] = stored.try_emplace(part.mesh.get());
                if (added) entry->second = store(*part.mesh, streams);
                draw = entry->second;
            }
            draw.node = node;
            draw.material = part.material;
            if (draw.index_count > 0) parts_.push_back(draw);
        }
    }
    vertex_array_ = gl::make_vertex_array();
    if (!parts_.empty()) make_arrays(streams);
}

void SceneBuffers::make_arrays(const Streams& streams) {
    vertices_ = gl::make_buffer(streams.vertices.size() * sizeof(Vertex), streams.vertices.data(),
                                streams.any_deformation ? GL_DYNAMIC_STORAGE_BIT : 0);
    indices_ = gl::make_buffer(streams.indices.size() * sizeof(std::uint32_t), streams.indices.data(), 0);

    const GLuint array = vertex_array_.name();
    glVertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array, indices_.name());
    const auto attribute = [&](GLuint location, GLint size, std::size_t offset, GLuint buffer = 0) {
        glEnableVertexArrayAttrib(array, location);
        glVertexArrayAttribFormat(array, location, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
        glVertexArrayAttribBinding(array, location, buffer);
    };
    attribute(0, 3, offsetof(Vertex, position));
    attribute(1, 3, offsetof(Vertex, normal));
    attribute(2, 2, offsetof(Vertex, uv));
    attribute(3, 3, offsetof(Vertex, tint));
    if (!streams.any_extras) return;
    static_assert(sizeof(VertexExtra) == 3 * sizeof(float));
    extras_ = gl::make_buffer(streams.extras.size() * sizeof(VertexExtra), streams.extras.data(), 0);
    glVertexArrayVertexBuffer(array, 1, extras_.name(), 0, sizeof(VertexExtra));
    attribute(4, 3, 0, 1);
}

void SceneBuffers::deform(const Scene& scene, const std::vector<glm::dmat4>& nodes, double time) {
    for (DrawPart& part : parts_) {
        if (!part.mesh->deformation) continue;
        scene.deform(part.node, *part.mesh, nodes, time, deformed_);
        part.bounds = {};
        for (const Vertex& vertex : deformed_)
            part.bounds.add(glm::dvec3(vertex.position));
        glNamedBufferSubData(
            vertices_.name(),
            static_cast<GLintptr>(static_cast<std::size_t>(part.base_vertex) * sizeof(Vertex)),
            static_cast<GLsizeiptr>(deformed_.size() * sizeof(Vertex)), deformed_.data());
    }
}

void SceneBuffers::upload_materials(const Scene& scene) {
    GLint alignment = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    const auto step = static_cast<std::size_t>(alignment);
    material_stride_ = (sizeof(MaterialBlock) + step - 1) / step * step;
    std::vector<std::byte> bytes(material_stride_ * std::max<std::size_t>(scene.materials.size(), 1));
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const MaterialBlock block = block_of(material);
        std::memcpy(bytes.data() + i * material_stride_, &block, sizeof block);
        Textures textures{.any = material.textured() || material.alpha_cutoff > 0};
        const auto maps = textures_of(material);
        for (std::size_t map = 0; map < maps.size(); ++map) {
            textures.names[map] = texture_of(*maps[map]);
            textures.samplers[map] = sampler_of(*maps[map]);
        }
        textures_of_material_.push_back(textures);
    }
    materials_ = gl::make_buffer(bytes.size(), bytes.data(), 0);
}

GLuint SceneBuffers::texture_of(const Texture& texture) {
    if (!texture) return white_.name();
    auto& uploaded = textures_[texture.picture];
    if (!uploaded) uploaded = upload(*texture.picture);
    return uploaded.name();
}

GLuint SceneBuffers::sampler_of(const Texture& texture) {
    auto& sampler = samplers_[texture.sampler];
    if (!sampler) sampler = make(texture.sampler);
    return sampler.name();
}

void SceneBuffers::bind_material(std::size_t material) const {
    glBindBufferRange(GL_UNIFORM_BUFFER, 1, materials_.name(),
                      static_cast<GLintptr>(material * material_stride_), sizeof(MaterialBlock));
    const Textures& textures = textures_of_material_[material];
    if (!textures.any) return;
    constexpr GLsizei before_shadows = 4; // unit 4 has the shadow maps
    glBindTextures(0, before_shadows, textures.names);
    glBindSamplers(0, before_shadows, textures.samplers);
    glBindTextureUnit(5, textures.names[4]);
    glBindSampler(5, textures.samplers[4]);
}

void SceneBuffers::unbind_samplers() {
    glBindSamplers(0, material_textures + 1, nullptr);
}

} // namespace postfx::host
