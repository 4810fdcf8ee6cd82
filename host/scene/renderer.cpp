#include "renderer.hpp"

#include "projection.hpp"
#include "scene_buffers.hpp"
#include "scene_targets.hpp"
#include "shadow_maps.hpp"
#include "view_block.hpp"

#include <postfx/attachment.hpp>
#include <postfx/error.hpp>

#include <fmt/format.h>
#include <gl/context.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace postfx::host {
namespace {

OutputNames outputs_for(const std::vector<std::string>& wanted) {
    const std::vector<std::string> known = attachment_names();
    for (const std::string& name : wanted) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            throw Error(fmt::format("a scene has no attachment \"{}\"{}; it has {}", name,
                                    did_you_mean(name, known), fmt::join(known, ", ")));
        }
    }
    OutputNames outputs{"color"};
    for (const std::string& name : known) {
        const bool is_output =
            name != "color" && name != "depth"; // color is there, depth is no colour output
        if (is_output && std::find(wanted.begin(), wanted.end(), name) != wanted.end())
            outputs.push_back(name);
    }
    return outputs;
}

using MeshPrograms = std::map<SurfaceCode, gl::Program>; ///< one for each kind of surface in the scene

/// A frame's part: where it is and how far.
struct Draw {
    const DrawPart* part;
    double distance; ///< from the eye to the middle of its bounds, metres
};

} // namespace

std::map<std::string, Format> SceneRenderer::attachment_formats() {
    std::map<std::string, Format> formats;
    for (const AttachmentInfo& info : known_attachments) {
        const bool is_depth = info.holds == AttachmentInfo::Holds::depth;
        formats.emplace(info.name, is_depth ? Format::depth32f : Format::rgba16f);
    }
    return formats;
}

std::uint32_t SceneFrame::texture(const std::string& name) const {
    for (const SceneAttachment& attachment : attachments) {
        if (attachment.name == name) return attachment.texture;
    }
    return 0;
}

struct SceneRenderer::State {
    State(Scene given, SceneRendererOptions given_options)
        : scene(std::move(given)), options(given_options), buffers(scene), shadows(scene),
          view_buffer(gl::make_buffer(sizeof(ViewBlock), nullptr)), empty_array(gl::make_vertex_array()),
          sky_program(make_sky_program()), depth_program(make_depth_program()) {
        if (options.samples != 1 && options.samples != 4) {
            throw Error(fmt::format("{} samples per pixel, expected 1 or 4", options.samples));
        }
    }

    void prepare(int width, int height, const std::vector<std::string>& wanted);
    const MeshPrograms& programs_for(const OutputNames& outputs);
    SurfaceCode code_of(const DrawPart& part) const;
    ViewBlock make_view(const Camera& camera, glm::dvec2 shift, int width, int height);
    void add_lights(ViewBlock& view) const;
    void collect();
    glm::dvec3 eye() const { return glm::dvec3(glm::make_mat4(frame.camera.view_to_world.data())[3]); }
    void draw_depth();
    void draw_list(const std::vector<Draw>& list);
    void draw_one(const Draw& draw) const;
    void draw_sky();
    void mask_outputs(bool normal, bool others) const;

    Scene scene;
    SceneRendererOptions options;
    SceneBuffers buffers;
    ShadowMaps shadows;
    gl::Buffer view_buffer;
    gl::VertexArray empty_array;
    gl::Program sky_program, depth_program;
    std::optional<SceneTargets> targets;
    /// By outputs: what is wanted may change with every frame, and programs take long to make.
    std::map<OutputNames, MeshPrograms> programs;
    const MeshPrograms* mesh_programs = nullptr; ///< for the targets' outputs

    // Of the frame being drawn; kept so that steady frames allocate nothing.
    std::vector<glm::dmat4> nodes;
    glm::dmat4 world_to_clip{1};
    std::vector<Draw> opaque, transparent;
    SceneFrame frame;
};

void SceneRenderer::State::prepare(int width, int height, const std::vector<std::string>& wanted) {
    OutputNames outputs = outputs_for(wanted);
    if (width < 1 || height < 1)
        throw Error(fmt::format("a picture of {}x{} pixels can't be drawn", width, height));
    const auto is_wanted = [&](const char* name) {
        return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    };
    // Which sample is nearest is seen in depth.
    const bool resolve_depth = options.samples > 1 && (is_wanted("depth") || is_wanted("normal"));
    const bool same_outputs =
        targets && targets->outputs() == outputs && targets->resolves_depth() == resolve_depth;
    if (same_outputs && targets->width() == width && targets->height() == height) return;
    mesh_programs = &programs_for(outputs);
    targets.reset(); // first, so that there is never memory for both
    targets.emplace(width, height, outputs, options.samples, resolve_depth);
    frame.attachments = {{"color", targets->output(0), Format::rgba16f}};
    if (options.samples == 1 || resolve_depth)
        frame.attachments.push_back({"depth", targets->depth(), Format::depth32f});
    frame.texture_bytes = targets->bytes();
    for (std::size_t i = 1; i < outputs.size(); ++i) {
        frame.attachments.push_back({outputs[i], targets->output(i), Format::rgba16f});
    }
}

const MeshPrograms& SceneRenderer::State::programs_for(const OutputNames& outputs) {
    const auto [made, is_new] = programs.try_emplace(outputs);
    if (!is_new) return made->second;
    const std::vector<LightCode> lights = shadows.light_codes(scene);
    for (const DrawPart& part : buffers.parts()) {
        gl::Program& program = made->second[code_of(part)];
        if (!program) program = make_mesh_program(outputs, code_of(part), lights);
    }
    return made->second;
}

SurfaceCode SceneRenderer::State::code_of(const DrawPart& part) const {
    return surface_code(scene.materials[part.material], !part.mesh->extras.empty());
}

ViewBlock SceneRenderer::State::make_view(const Camera& camera, glm::dvec2 shift, int width, int height) {
    const Projection projection = make_projection(camera, static_cast<double>(width) / height, shift);
    const glm::dmat4 view_to_world = glm::make_mat4(camera.view_to_world.data());
    const glm::dmat4 world_to_view = glm::inverse(view_to_world);
    const Surroundings& around = scene.surroundings;
    const double pixel =
        2 * projection.half_extent.y / height; // radians in the middle of a perspective picture

    ViewBlock view{};
    world_to_clip = projection.view_to_clip * world_to_view;
    view.offset_to_clip = glm::mat4(projection.view_to_clip * glm::dmat4(glm::dmat3(world_to_view)));
    view.world_to_view = glm::mat4(world_to_view);
    view.clip_to_direction = glm::mat4(view_to_world * projection.clip_to_direction);
    view.backward = glm::vec4(glm::vec3(view_to_world[2]), camera.orthographic ? 0.0f : 1.0f);
    view.zenith = glm::vec4(around.zenith, around.stars);
    view.horizon = glm::vec4(around.horizon, 0);
    view.ground = glm::vec4(around.ground, 1);
    view.disc_color = glm::vec4(glm::vec3(0), static_cast<float>(pixel));
    if (around.disc) {
        view.horizon.w = around.disc->halo;
        view.ground.w = std::cos(glm::radians(around.disc->angular_radius));
        view.disc_color = glm::vec4(around.disc->color, view.disc_color.w);
        view.disc = glm::vec4(around.disc->direction, 1);
    }
    view.ambient_up = glm::vec4(around.ambient_up, 0);
    view.ambient_down = glm::vec4(around.ambient_down, 0);
    add_lights(view);
    return view;
}

void SceneRenderer::State::add_lights(ViewBlock& view) const {
    const std::size_t count = std::min(scene.lights.size(), max_lights);
    for (std::size_t i = 0; i < count; ++i) {
        const Light& light = scene.lights[i];
        const glm::dmat4& place = nodes[light.node];
        const float outer = std::cos(glm::radians(light.outer_angle)),
                    inner = std::cos(glm::radians(light.inner_angle));
        view.lights[i] = {glm::vec4(glm::vec3(glm::dvec3(place[3]) - eye()), 1),
                          glm::vec4(glm::vec3(glm::normalize(glm::dvec3(-place[2]))), outer),
                          glm::vec4(light.color, 1 / std::max(inner - outer, 1e-4f)),
                          glm::vec4(light.attenuation, light.range)};
    }
    shadows.describe(view, eye());
}

void SceneRenderer::State::collect() {
    opaque.clear();
    transparent.clear();
    frame.draws = frame.triangles = 0;
    for (const DrawPart& part : buffers.parts()) {
        const Bounds bounds = part.bounds.transformed(nodes[part.node]);
        if (outside(world_to_clip, bounds)) continue;
        auto& list = scene.materials[part.material].blended ? transparent : opaque;
        list.push_back({&part, glm::length(bounds.center() - eye())});
        ++frame.draws;
        frame.triangles += static_cast<std::size_t>(part.index_count) / 3;
    }
    std::sort(opaque.begin(), opaque.end(),
              [](const Draw& a, const Draw& b) { return a.distance < b.distance; });
    std::sort(transparent.begin(), transparent.end(),
              [](const Draw& a, const Draw& b) { return a.distance > b.distance; });
}

void SceneRenderer::State::draw_one(const Draw& draw) const {
    const glm::dmat4& to_world = nodes[draw.part->node];
    glm::dmat4 to_offset = to_world;
    to_offset[3] -= glm::dvec4(eye(), 0);
    const glm::mat4 object_to_offset(to_offset);
    const glm::mat3 normal_to_world(normal_matrix(to_world));
    glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(object_to_offset));
    glUniformMatrix3fv(1, 1, GL_FALSE, glm::value_ptr(normal_to_world));
    glFrontFace(glm::determinant(glm::dmat3(to_world)) < 0 ? GL_CW : GL_CCW);
    (scene.materials[draw.part->material].two_sided ? glDisable : glEnable)(GL_CULL_FACE);
    glDrawElementsBaseVertex(GL_TRIANGLES, draw.part->index_count, GL_UNSIGNED_INT,
                             reinterpret_cast<const void*>(draw.part->first_index), draw.part->base_vertex);
}

/// Depth of everything opaque first: geometry costs little beside light, and so light is reckoned once per
/// pixel.
void SceneRenderer::State::draw_depth() {
    glUseProgram(depth_program.name());
    glBindVertexArray(buffers.vertex_array());
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (const Draw& draw : opaque) {
        if (scene.materials[draw.part->material].alpha_cutoff == 0) draw_one(draw);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void SceneRenderer::State::draw_list(const std::vector<Draw>& list) {
    glBindVertexArray(buffers.vertex_array());
    for (const Draw& draw : list) {
        glUseProgram(mesh_programs->at(code_of(*draw.part)).name());
        buffers.bind_material(draw.part->material);
        draw_one(draw);
    }
    SceneBuffers::unbind_samplers();
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
}

/// Which outputs the next draws may write besides color.
void SceneRenderer::State::mask_outputs(bool normal, bool others) const {
    const OutputNames& outputs = targets->outputs();
    for (std::size_t i = 1; i < outputs.size(); ++i) {
        const GLboolean open = (outputs[i] == "normal" ? normal : others) ? GL_TRUE : GL_FALSE;
        glColorMaski(static_cast<GLuint>(i), open, open, open, open);
    }
}

void SceneRenderer::State::draw_sky() {
    mask_outputs(false, false);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL); // where depth is still that of infinity
    glUseProgram(sky_program.name());
    glBindVertexArray(empty_array.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_GREATER);
    mask_outputs(true, true);
}

SceneRenderer::SceneRenderer(Scene scene, SceneRendererOptions options)
    : state_(std::make_unique<State>(std::move(scene), options)) {}
SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

const Scene& SceneRenderer::scene() const {
    return state_->scene;
}

SceneFrame SceneRenderer::render(int width, int height, double time, const std::vector<std::string>& wanted,
                                 const std::optional<CameraOverride>& camera) {
    State& s = *state_;
    const gl::DebugGroup group("scene");
    s.prepare(width, height, wanted);
    s.scene.place_nodes(time, s.nodes);
    s.buffers.deform(s.scene, s.nodes, time);
    s.frame.camera = drawable(camera ? camera->camera : s.scene.camera_at(time, s.nodes));

    // Depth runs from 1 at the near plane to 0 at infinity, for shadow maps too.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    s.shadows.draw(s.scene, s.nodes, s.frame.camera, s.buffers);

    const ViewBlock view = s.make_view(s.frame.camera, camera ? camera->shift : glm::dvec2(0), width, height);
    glNamedBufferSubData(s.view_buffer.name(), 0, sizeof view, &view);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, s.view_buffer.name());
    glBindTextureUnit(4, s.shadows.texture());
    s.collect();

    s.targets->begin();
    s.draw_depth();
    glDepthFunc(GL_GEQUAL);
    s.draw_list(s.opaque);
    s.draw_sky();
    if (!s.transparent.empty()) {
        s.mask_outputs(false, true);
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE); // colours come times opacity
        s.draw_list(s.transparent);
        glDisable(GL_BLEND);
        s.mask_outputs(true, true);
    }
    s.targets->resolve(s.empty_array.name());

    // As OpenGL's defaults, which other drawing may count on.
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    return s.frame;
}

} // namespace postfx::host
