#include <execute/framebuffer_output.hpp>

#include <gl/full_screen.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

namespace postfx {
namespace {

constexpr std::string_view copy_shader = R"(#version 450 core
layout(binding = 0) uniform sampler2D u_picture;
layout(location = 0) uniform vec4 u_rectangle; // x, y, width, height
layout(location = 0) out vec4 o_color;
void main() {
    o_color = texture(u_picture, (gl_FragCoord.xy - u_rectangle.xy) / u_rectangle.zw);
}
)";

bool holds_integers(GLuint framebuffer) {
    if (framebuffer == 0) return false; // windows have none
    GLint object = GL_NONE, type = GL_NONE;
    glGetNamedFramebufferAttachmentParameteriv(framebuffer, GL_COLOR_ATTACHMENT0,
                                               GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &object);
    if (object == GL_NONE) return false;
    glGetNamedFramebufferAttachmentParameteriv(framebuffer, GL_COLOR_ATTACHMENT0,
                                               GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE, &type);
    return type == GL_INT || type == GL_UNSIGNED_INT;
}

} // namespace

void check_output(const OutputTarget& output) {
    const auto refuse = [&](const std::string& why) {
        throw Error(fmt::format("output framebuffer {}: {}", output.framebuffer, why));
    };
    if (output.width < 1 || output.height < 1)
        refuse(fmt::format("a rectangle of {}x{} has no pixels", output.width, output.height));
    if (output.framebuffer != 0 && !glIsFramebuffer(output.framebuffer))
        refuse("there is no framebuffer of that name in this context");
    const GLenum status = glCheckNamedFramebufferStatus(output.framebuffer, GL_DRAW_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_UNDEFINED) refuse("the context has no window");
    if (status != GL_FRAMEBUFFER_COMPLETE) refuse(fmt::format("it is not complete (0x{:x})", status));
    if (holds_integers(output.framebuffer))
        refuse("it holds integers; normalised codes or floats are expected");
}

FramebufferOutput::FramebufferOutput()
    : program_(gl::make_program(gl::full_screen_vertex_text, copy_shader, "output")),
      nearest_(gl::make_sampler(false)), linear_(gl::make_sampler(true)) {}

void FramebufferOutput::draw(GLuint picture, int width, int height, const OutputTarget& output) const {
    const auto x = static_cast<float>(output.x), y = static_cast<float>(output.y);
    const auto across = static_cast<float>(output.width), up = static_cast<float>(output.height);
    const bool same_size = output.width == width && output.height == height;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, output.framebuffer);
    glViewportIndexedf(0, x, y, across, up);
    glUseProgram(program_.name());
    glUniform4f(0, x, y, across, up);
    glBindTextureUnit(0, picture);
    glBindSampler(0, (same_size ? nearest_ : linear_).name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace postfx
