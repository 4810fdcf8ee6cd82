#include <gl/pass_state.hpp>

#include <algorithm>
#include <cassert>
#include <utility>

namespace postfx::gl {
namespace {

/// Whatever of these is on could change, double or discard what a full-screen triangle draws. Blending and the scissor
/// test are switched per draw buffer and viewport.
constexpr std::array<GLenum, 23> switches = {GL_DEPTH_TEST,
                                             GL_STENCIL_TEST,
                                             GL_CULL_FACE,
                                             GL_FRAMEBUFFER_SRGB,
                                             GL_DITHER,
                                             GL_COLOR_LOGIC_OP,
                                             GL_RASTERIZER_DISCARD,
                                             GL_POLYGON_SMOOTH,
                                             GL_SAMPLE_ALPHA_TO_COVERAGE,
                                             GL_SAMPLE_ALPHA_TO_ONE,
                                             GL_SAMPLE_COVERAGE,
                                             GL_SAMPLE_MASK,
                                             GL_SAMPLE_SHADING,
                                             GL_PRIMITIVE_RESTART,
                                             GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                             GL_CLIP_DISTANCE0,
                                             GL_CLIP_DISTANCE1,
                                             GL_CLIP_DISTANCE2,
                                             GL_CLIP_DISTANCE3,
                                             GL_CLIP_DISTANCE4,
                                             GL_CLIP_DISTANCE5,
                                             GL_CLIP_DISTANCE6,
                                             GL_CLIP_DISTANCE7};

constexpr std::array<GLenum, 8> packing = {GL_PACK_SWAP_BYTES,   GL_PACK_LSB_FIRST,   GL_PACK_ROW_LENGTH,
                                           GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS,
                                           GL_PACK_SKIP_IMAGES,  GL_PACK_ALIGNMENT};

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

GLuint name_of(GLint value) {
    return static_cast<GLuint>(value);
}

void set(GLenum capability, GLboolean on) {
    if (on) {
        glEnable(capability);
    } else {
        glDisable(capability);
    }
}

void set(GLenum capability, GLuint index, GLboolean on) {
    if (on) {
        glEnablei(capability, index);
    } else {
        glDisablei(capability, index);
    }
}

/// The current program; 0 if the host has deleted it, since it ends when another one takes its place.
GLint program_to_keep() {
    const GLint program = integer(GL_CURRENT_PROGRAM);
    GLint deleted = GL_FALSE;
    if (program != 0) glGetProgramiv(name_of(program), GL_DELETE_STATUS, &deleted);
    return deleted ? 0 : program;
}

/// Of the active unit. glBindTextureUnit() with 0 would take the unit's textures of all other kinds with it.
void bind_texture(GLenum target, GLint texture, GLuint unit, GLint sampler) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, name_of(texture));
    glBindSampler(unit, name_of(sampler));
}

} // namespace

void set_pass_state() {
    for (GLenum capability : switches)
        glDisable(capability);
    glDisable(GL_BLEND);
    glDisablei(GL_SCISSOR_TEST, 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

bool transform_feedback_runs() {
    return integer(GL_TRANSFORM_FEEDBACK_ACTIVE) != 0 && integer(GL_TRANSFORM_FEEDBACK_PAUSED) == 0;
}

SavedState::SavedState(const StateUse& use) : use_(use) {
    assert(use.texture_units <= most_texture_units && use.storage_buffers <= most_storage_buffers);
    if (transform_feedback_runs()) {
        glPauseTransformFeedback();
        paused_feedback_ = true;
    }
    save_raster();
    save_bindings();
}

SavedState::~SavedState() {
    restore_raster();
    restore_bindings();
    if (paused_feedback_) glResumeTransformFeedback(); // wants the host's program to be bound
}

void SavedState::save_raster() {
    static_assert(switch_count == switches.size());
    std::transform(switches.begin(), switches.end(), raster_.switches.begin(),
                   [](GLenum capability) { return glIsEnabled(capability); });
    for (GLuint i = 0; i < draw_buffers; ++i) {
        raster_.blends[i] = glIsEnabledi(GL_BLEND, i);
        glGetBooleani_v(GL_COLOR_WRITEMASK, i, raster_.color_masks[i].data());
    }
    raster_.scissor = glIsEnabledi(GL_SCISSOR_TEST, 0);
    // Some drivers answer for front and back, as before OpenGL 3.2.
    std::array<GLint, 2> polygon_modes{};
    glGetIntegerv(GL_POLYGON_MODE, polygon_modes.data());
    raster_.polygon_mode = polygon_modes[0];
    raster_.clip_origin = integer(GL_CLIP_ORIGIN);
    raster_.clip_depth = integer(GL_CLIP_DEPTH_MODE);
    glGetFloati_v(GL_VIEWPORT, 0, raster_.viewport.data());
}

void SavedState::restore_raster() const {
    for (std::size_t i = 0; i < switches.size(); ++i)
        set(switches[i], raster_.switches[i]);
    for (GLuint i = 0; i < draw_buffers; ++i) {
        const auto& mask = raster_.color_masks[i];
        set(GL_BLEND, i, raster_.blends[i]);
        glColorMaski(i, mask[0], mask[1], mask[2], mask[3]);
    }
    set(GL_SCISSOR_TEST, 0, raster_.scissor);
    glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(raster_.polygon_mode));
    glClipControl(static_cast<GLenum>(raster_.clip_origin), static_cast<GLenum>(raster_.clip_depth));
    glViewportIndexedfv(0, raster_.viewport.data());
}

SavedState::IndexedBuffer SavedState::indexed_buffer(GLenum binding, GLenum start, GLenum size,
                                                     GLuint index) {
    IndexedBuffer buffer;
    glGetIntegeri_v(binding, index, &buffer.name);
    if (buffer.name == 0) return buffer;
    glGetInteger64i_v(start, index, &buffer.start);
    glGetInteger64i_v(size, index, &buffer.size);
    return buffer;
}

void SavedState::bind(GLenum target, GLuint index, const IndexedBuffer& buffer) {
    if (buffer.size == 0) { // the whole buffer, or none
        glBindBufferBase(target, index, name_of(buffer.name));
    } else {
        glBindBufferRange(target, index, name_of(buffer.name), static_cast<GLintptr>(buffer.start),
                          static_cast<GLsizeiptr>(buffer.size));
    }
}

void SavedState::save_bindings() {
    bindings_ = {.draw_framebuffer = integer(GL_DRAW_FRAMEBUFFER_BINDING),
                 .read_framebuffer = integer(GL_READ_FRAMEBUFFER_BINDING),
                 .program = program_to_keep(),
                 .vertex_array = integer(GL_VERTEX_ARRAY_BINDING),
                 .draw_indirect = integer(GL_DRAW_INDIRECT_BUFFER_BINDING),
                 .dispatch_indirect = integer(GL_DISPATCH_INDIRECT_BUFFER_BINDING),
                 .uniform = integer(GL_UNIFORM_BUFFER_BINDING),
                 .storage = integer(GL_SHADER_STORAGE_BUFFER_BINDING),
                 .active_texture = integer(GL_ACTIVE_TEXTURE)};
    for (GLuint i = 0; i < uniform_buffers; ++i) {
        uniform_buffers_[i] =
            indexed_buffer(GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE, i);
    }
    for (GLuint i = 0; i < use_.storage_buffers; ++i) {
        storage_buffers_[i] = indexed_buffer(GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                                             GL_SHADER_STORAGE_BUFFER_SIZE, i);
    }
    for (GLuint unit = 0; unit < use_.texture_units; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        units_[unit] = {integer(GL_TEXTURE_BINDING_2D), integer(GL_SAMPLER_BINDING)};
    }
    if (use_.buffer_texture_unit) {
        glActiveTexture(GL_TEXTURE0 + buffer_texture_unit);
        buffer_texture_ = {integer(GL_TEXTURE_BINDING_BUFFER), integer(GL_SAMPLER_BINDING)};
    }
}

void SavedState::restore_bindings() const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name_of(bindings_.draw_framebuffer));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, name_of(bindings_.read_framebuffer));
    glUseProgram(name_of(bindings_.program));
    glBindVertexArray(name_of(bindings_.vertex_array));
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, name_of(bindings_.draw_indirect));
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, name_of(bindings_.dispatch_indirect));
    for (GLuint i = 0; i < uniform_buffers; ++i)
        bind(GL_UNIFORM_BUFFER, i, uniform_buffers_[i]);
    for (GLuint i = 0; i < use_.storage_buffers; ++i)
        bind(GL_SHADER_STORAGE_BUFFER, i, storage_buffers_[i]);
    // Binding to an index binds to the target too.
    glBindBuffer(GL_UNIFORM_BUFFER, name_of(bindings_.uniform));
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, name_of(bindings_.storage));
    for (GLuint unit = 0; unit < use_.texture_units; ++unit)
        bind_texture(GL_TEXTURE_2D, units_[unit].texture, unit, units_[unit].sampler);
    if (use_.buffer_texture_unit)
        bind_texture(GL_TEXTURE_BUFFER, buffer_texture_.texture, buffer_texture_unit,
                     buffer_texture_.sampler);
    glActiveTexture(static_cast<GLenum>(bindings_.active_texture));
}

TightPacking::TightPacking()
    : buffer_(integer(GL_PIXEL_PACK_BUFFER_BINDING)), clamp_(integer(GL_CLAMP_READ_COLOR)) {
    static_assert(setting_count == packing.size());
    for (std::size_t i = 0; i < packing.size(); ++i) {
        settings_[i] = integer(packing[i]);
        glPixelStorei(packing[i], packing[i] == GL_PACK_ALIGNMENT ? 1 : 0);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
}

TightPacking::~TightPacking() {
    for (std::size_t i = 0; i < packing.size(); ++i)
        glPixelStorei(packing[i], settings_[i]);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, name_of(buffer_));
    glClampColor(GL_CLAMP_READ_COLOR, static_cast<GLenum>(clamp_));
}

} // namespace postfx::gl
