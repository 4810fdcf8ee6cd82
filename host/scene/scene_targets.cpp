#include "scene_targets.hpp"

namespace postfx::host {
namespace {

gl::Handle<gl::destroy_texture> make_samples(int width, int height, GLenum format, int samples) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &name);
    glTextureStorage2DMultisample(name, samples, format, width, height, GL_TRUE);
    return gl::Handle<gl::destroy_texture>(name);
}

std::vector<GLuint> names_of(const auto& owners) {
    std::vector<GLuint> names;
    for (const auto& owner : owners)
        names.push_back(owner.name());
    return names;
}

} // namespace

SceneTargets::SceneTargets(int width, int height, OutputNames outputs, int samples, bool resolve_depth)
    : outputs_(std::move(outputs)), samples_(samples), resolve_depth_(samples > 1 && resolve_depth) {
    for (std::size_t i = 0; i < outputs_.size(); ++i)
        colors_.emplace_back(width, height, Format::rgba16f);
    if (samples_ == 1 || resolve_depth_) depth_ = gl::Texture(width, height, Format::depth32f);
    framebuffer_ = gl::make_framebuffer(names_of(colors_), depth_.name());
    if (samples_ == 1) return;
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
        sample_colors_.push_back(make_samples(width, height, GL_RGBA16F, samples_));
    }
    sample_depth_ = make_samples(width, height, GL_DEPTH_COMPONENT32F, samples_);
    sample_framebuffer_ = gl::make_framebuffer(names_of(sample_colors_), sample_depth_.name());
    resolve_program_ = make_resolve_program(outputs_, samples_, resolve_depth_);
}

std::size_t SceneTargets::bytes() const {
    const std::size_t pixels = static_cast<std::size_t>(width()) * height();
    const std::size_t color = format_info(Format::rgba16f).bytes_per_pixel * outputs_.size();
    const std::size_t depth = format_info(Format::depth32f).bytes_per_pixel;
    if (samples_ == 1) return pixels * (color + depth);
    return pixels
           * (static_cast<std::size_t>(samples_) * (color + depth) + color + (resolve_depth_ ? depth : 0));
}

void SceneTargets::begin() const {
    const GLuint framebuffer = samples_ > 1 ? sample_framebuffer_.name() : framebuffer_.name();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width(), height());
    const GLfloat nothing[4] = {0, 0, 0, 0};
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
        glClearNamedFramebufferfv(framebuffer, GL_COLOR, static_cast<GLint>(i), nothing);
    }
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, nothing);
}

void SceneTargets::resolve(GLuint empty_vertex_array) const {
    if (samples_ == 1) return;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    if (!resolve_depth_) glDisable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    glUseProgram(resolve_program_.name());
    if (resolve_depth_) glBindTextureUnit(0, sample_depth_.name());
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
        glBindTextureUnit(static_cast<GLuint>(i) + 1, sample_colors_[i].name());
    }
    glBindVertexArray(empty_vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace postfx::host
