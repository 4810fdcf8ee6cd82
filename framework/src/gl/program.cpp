#include <gl/objects.hpp>
#include <gl/program_log.hpp>

#include <array>

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

} // namespace

void destroy_program(GLuint name) {
    glDeleteProgram(name);
}

Program make_program(std::string_view vertex, std::string_view fragment, const std::string& what,
                     const std::vector<std::string>& files) {
    const std::array<NumberedSource, 2> sources = {NumberedSource(vertex), NumberedSource(fragment)};
    // Nothing is asked before linking, so that a driver that compiles in parallel is not waited for twice.
    const std::array<Shader, 2> shaders = {start_compile(GL_VERTEX_SHADER, sources[0]),
                                           start_compile(GL_FRAGMENT_SHADER, sources[1])};
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
            if (!compiled) throw program_error(shader_log(shaders[i].name()), what, sources[i], files);
        }
        throw program_error(program_log(program.name()), what, sources[1], files);
    }
    for (const Shader& shader : shaders)
        glDetachShader(program.name(), shader.name()); // so it can be freed
    return program;
}

} // namespace postfx::gl
