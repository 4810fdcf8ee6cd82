#include <gl/context.hpp>

#include <postfx_glad/gl.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace postfx::gl {
namespace {

constexpr std::size_t most_messages = 1000;

/// Debug output is synchronous here, so the driver calls back on the thread of the context.
thread_local std::vector<std::string> messages;

std::string_view severity_name(GLenum severity) {
    switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH:
        return "high";
    case GL_DEBUG_SEVERITY_MEDIUM:
        return "medium";
    case GL_DEBUG_SEVERITY_LOW:
        return "low";
    default:
        return "notification";
    }
}

std::string_view type_name(GLenum type) {
    switch (type) {
    case GL_DEBUG_TYPE_ERROR:
        return "error";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR:
        return "deprecated behavior";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
        return "undefined behavior";
    case GL_DEBUG_TYPE_PORTABILITY:
        return "portability";
    case GL_DEBUG_TYPE_PERFORMANCE:
        return "performance";
    default:
        return "other";
    }
}

void GLAD_API_PTR collect(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* message,
                          const void*) {
    if (messages.size() == most_messages) return;
    const std::string_view text(message, static_cast<std::size_t>(length));
    messages.push_back(fmt::format("{} ({}): {}", type_name(type), severity_name(severity), text));
}

} // namespace

void enable_debug_output() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
    glDebugMessageCallback(collect, nullptr);
}

std::vector<std::string> take_debug_messages() {
    return std::exchange(messages, {});
}

DebugGroup::DebugGroup(const char* name) {
    // Drivers refuse messages beyond a length of their own (4096 in Mesa): a pass of many effects has a long name.
    constexpr std::size_t longest = 255;
    const auto length = static_cast<GLsizei>(std::min(std::strlen(name), longest));
    if (postfx_glad_glPushDebugGroup) glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, length, name);
}

DebugGroup::~DebugGroup() {
    if (postfx_glad_glPopDebugGroup) glPopDebugGroup();
}

} // namespace postfx::gl
