#include <gl/objects.hpp>
#include <gl/program_log.hpp>

#include <array>
#include <span>
#include <utility>

namespace postfx::gl {
namespace {

using Shader = Handle<[](GLuint name) { glDeleteShader(name); }>;

Shader start_compile(GLenum stage, const NumberedSource& source) {
    Shader shader(glCreateShader(stage));
    const GLchar* text = source.text().c_str();
    glShaderSource(shader.name(), 1, &text, nullptr);
    glCompileShader(shader.name());
    return shader;
}

std::string shader_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

std::string program_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(program, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

/// Compile all stages, then link them.
Program link(std::span<const std::pair<GLenum, NumberedSource>> stages, const std::string& what,
             const std::vector<std::string>& files) {
    // Nothing is asked before linking, so that a driver that compiles in parallel is not waited for twice.
    std::vector<Shader> shaders;
    for (const auto& [stage, source] : stages)
        shaders.push_back(start_compile(stage, source));
    Program program(glCreateProgram());
    glProgramParameteri(program.name(), GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    for (const Shader& shader : shaders)
        glAttachShader(program.name(), shader.name());
    glLinkProgram(program.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (!linked) {
        for (std::size_t i = 0; i < shaders.size(); ++i) {
            GLint compiled = GL_FALSE;
            glGetShaderiv(shaders[i].name(), GL_COMPILE_STATUS, &compiled);
            if (!compiled) throw program_error(shader_log(shaders[i].name()), what, stages[i].second, files);
        }
        throw program_error(program_log(program.name()), what, stages.back().second, files);
    }
    for (const Shader& shader : shaders)
        glDetachShader(program.name(), shader.name()); // so it can be freed
    return program;
}

} // namespace

void destroy_program(GLuint name) {
    glDeleteProgram(name);
}

Program make_program(std::string_view vertex, std::string_view fragment, const std::string& what,
                     const std::vector<std::string>& files) {
    const std::array<std::pair<GLenum, NumberedSource>, 2> stages = {
        std::pair(GLenum{GL_VERTEX_SHADER}, NumberedSource(vertex)),
        std::pair(GLenum{GL_FRAGMENT_SHADER}, NumberedSource(fragment))};
    return link(stages, what, files);
}

Program make_compute_program(std::string_view compute, const std::string& what,
                             const std::vector<std::string>& files) {
    const std::array stages = {std::pair(GLenum{GL_COMPUTE_SHADER}, NumberedSource(compute))};
    return link(stages, what, files);
}

} // namespace postfx::gl
