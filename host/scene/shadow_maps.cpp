#include "shadow_maps.hpp"

#include "projection.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

constexpr int map_size = 1024;
constexpr double widest_spot = 120; ///< degrees; beyond, texels in the middle get too coarse
/// A directional light's near plane scales with what it covers, which may be a model of a millimetre.
constexpr double nearest_of_extent = 0.0025;

/// The light as a camera: to view from the light's node, and the projection.
Camera light_camera(const Light& light, const glm::dmat4& place, const Camera& viewer) {
    glm::dmat4 frame = place;
    for (int axis = 0; axis < 3; ++axis)
        frame[axis] = glm::normalize(frame[axis]);
    Camera camera;
    if (light.kind == Light::Kind::directional) {
        // Around the middle of what the viewer sees up to the extent, at whole texels so that edges don't
        // crawl.
        const double extent = static_cast<double>(light.shadow_extent);
        const glm::dmat4 viewer_to_world = glm::make_mat4(viewer.view_to_world.data());
        const glm::dvec3 middle(viewer_to_world[3] - viewer_to_world[2] * (0.45 * extent));
        const double texel = extent / map_size;
        glm::dvec3 in_light(glm::transpose(glm::dmat3(frame)) * middle);
        in_light = glm::dvec3(std::floor(in_light.x / texel) * texel, std::floor(in_light.y / texel) * texel,
                              in_light.z + 2 * extent);
        frame[3] = glm::dvec4(glm::dmat3(frame) * in_light, 1);
        camera = Camera::parallel(extent, nearest_of_extent * extent, 4 * extent);
    } else {
        camera = Camera::perspective(std::min(2 * static_cast<double>(light.outer_angle), widest_spot),
                                     static_cast<double>(light.shadow_near));
    }
    std::copy_n(glm::value_ptr(frame), 16, camera.view_to_world.begin());
    return camera;
}

} // namespace

ShadowMaps::ShadowMaps(const Scene& scene) {
    for (std::size_t i = 0; i < std::min(scene.lights.size(), max_lights); ++i) {
        const Light& light = scene.lights[i];
        if (light.casts_shadow && light.kind != Light::Kind::point && maps_.size() < max_shadows) {
            maps_.push_back({i, {}, glm::mat4(1), 0, light.shadow_softness});
        }
    }
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    texture_ = gl::Handle<gl::destroy_texture>(name);
    const int size = maps_.empty() ? 1 : map_size;
    glTextureStorage3D(name, 1, GL_DEPTH_COMPONENT32F, size, size,
                       static_cast<GLsizei>(std::max<std::size_t>(maps_.size(), 1)));
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL); // reversed depth: lit is as near or nearer
    for (std::size_t layer = 0; layer < maps_.size(); ++layer) {
        GLuint framebuffer = 0;
        glCreateFramebuffers(1, &framebuffer);
        maps_[layer].framebuffer = gl::Framebuffer(framebuffer);
        glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, name, 0, static_cast<GLint>(layer));
        glNamedFramebufferDrawBuffer(framebuffer, GL_NONE);
    }
    if (maps_.empty()) return;
    program_ = make_shadow_program();
    const bool any_cut = std::any_of(scene.materials.begin(), scene.materials.end(),
                                     [](const Material& material) { return material.alpha_cutoff > 0; });
    if (any_cut) cut_program_ = make_cut_shadow_program();
}

void ShadowMaps::draw(const Scene& scene, const std::vector<glm::dmat4>& nodes, const Camera& camera,
                      const SceneBuffers& buffers) {
    if (maps_.empty()) return;
    glViewport(0, 0, map_size, map_size);
    glBindVertexArray(buffers.vertex_array());
    glVertexAttrib3f(4, 0, 0, 1); // where no mesh has extras
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.5f, -2); // away from the light, which is towards 0
    for (Map& map : maps_) {
        const Light& light = scene.lights[map.light];
        const Camera eye = light_camera(light, nodes[light.node], camera);
        const Projection projection = make_projection(eye, 1);
        const glm::dmat4 light_to_world = glm::make_mat4(eye.view_to_world.data());
        map.world_to_clip = projection.view_to_clip * glm::inverse(light_to_world);
        map.texel = static_cast<float>(2 * projection.half_extent.y / map_size);

        const GLfloat far_away = 0;
        glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer.name());
        glClearNamedFramebufferfv(map.framebuffer.name(), GL_DEPTH, 0, &far_away);
        for (const DrawPart& part : buffers.parts()) {
            const Material& material = scene.materials[part.material];
            if (material.blended) continue;
            const glm::dmat4& to_world = nodes[part.node];
            if (outside(map.world_to_clip, part.bounds.transformed(to_world))) continue;
            const bool cut = material.alpha_cutoff > 0;
            glUseProgram((cut ? cut_program_ : program_).name());
            if (cut) buffers.bind_material(part.material);
            const glm::mat4 to_light(map.world_to_clip * to_world);
            glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(to_light));
            glDrawElementsBaseVertex(GL_TRIANGLES, part.index_count, GL_UNSIGNED_INT,
                                     reinterpret_cast<const void*>(part.first_index), part.base_vertex);
        }
    }
    SceneBuffers::unbind_samplers();
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void ShadowMaps::describe(ViewBlock& view, glm::dvec3 eye) const {
    for (std::size_t layer = 0; layer < maps_.size(); ++layer) {
        view.offset_to_shadow[layer] = glm::mat4(glm::translate(maps_[layer].world_to_clip, eye));
        view.shadow_texel[layer] = {maps_[layer].texel, maps_[layer].softness, 0, 0};
    }
}

std::vector<LightCode> ShadowMaps::light_codes(const Scene& scene) const {
    std::vector<LightCode> codes;
    for (std::size_t i = 0; i < std::min(scene.lights.size(), max_lights); ++i)
        codes.push_back({scene.lights[i].kind, -1, scene.lights[i].range > 0});
    for (std::size_t layer = 0; layer < maps_.size(); ++layer)
        codes[maps_[layer].light].shadow_layer = static_cast<int>(layer);
    return codes;
}

} // namespace postfx::host
