#include <gl/cross_fade.hpp>

#include <gl/full_screen.hpp>

namespace postfx::gl {
namespace {

constexpr const char* add_shader =
    "#version 450 core\n"
    "layout(binding = 0) uniform sampler2D u_a;\n"
    "layout(binding = 1) uniform sampler2D u_b;\n"
    "layout(location = 0) uniform vec2 u_weights;\n"
    "layout(location = 1) uniform float u_codes;\n"
    "layout(location = 0) out vec4 o_color;\n"
    // Interleaved gradient noise (Jimenez 2014): pixels of one colour reach their next code one after the other.
    "float threshold(vec2 at) { return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715)))); }\n"
    "void main() {\n"
    "    ivec2 at = ivec2(gl_FragCoord.xy);\n"
    "    o_color = u_weights.x * texelFetch(u_a, at, 0) + u_weights.y * texelFetch(u_b, at, 0);\n"
    "    o_color += u_codes * (threshold(gl_FragCoord.xy) - 0.5) / 255.0;\n"
    "}\n";

} // namespace

CrossFade::CrossFade()
    : program_(make_program(full_screen_vertex_text, add_shader, "cross fade", {"cross fade"})),
      vertex_array_(make_vertex_array()) {}

void CrossFade::begin(std::uint32_t shown, int width, int height, int steps) {
    steps_ = steps;
    done_ = 0;
    if (steps < 2) return;
    before_.fit(width, height, Format::rgba8);
    glCopyImageSubData(shown, GL_TEXTURE_2D, 0, 0, 0, 0, before_.texture.name(), GL_TEXTURE_2D, 0, 0, 0, 0,
                       width, height, 1);
}

std::uint32_t CrossFade::show(std::uint32_t drawn, int width, int height) {
    if (done_ >= steps_ || ++done_ == steps_) return drawn;
    if (before_.texture.width() != width || before_.texture.height() != height) {
        done_ = steps_; // the window has another size: nothing fits together any more
        return drawn;
    }
    if (done_ == 1) {
        surplus_.fit(width, height, Format::rgba16f);
        add(surplus_, before_.texture.name(), 1, drawn, -1);
    }
    shown_.fit(width, height, Format::rgba8);
    add(shown_, drawn, 1, surplus_.texture.name(), 1 - static_cast<double>(done_) / steps_);
    return shown_.texture.name();
}

void CrossFade::Target::fit(int width, int height, Format format) {
    if (texture.width() == width && texture.height() == height) return;
    texture = Texture(width, height, format);
    framebuffer = make_framebuffer({texture.name()});
}

void CrossFade::add(const Target& target, std::uint32_t a, double weight_of_a, std::uint32_t b,
                    double weight_of_b) const {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer.name());
    glViewport(0, 0, target.texture.width(), target.texture.height());
    glUseProgram(program_.name());
    glBindVertexArray(vertex_array_.name());
    glBindTextureUnit(0, a);
    glBindTextureUnit(1, b);
    glProgramUniform1f(program_.name(), 1, target.texture.format() == Format::rgba8 ? 1.0f : 0.0f);
    glProgramUniform2f(program_.name(), 0, static_cast<float>(weight_of_a), static_cast<float>(weight_of_b));
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace postfx::gl
