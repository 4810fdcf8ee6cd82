#include "engine.hpp"

#if __has_include(<GL/glew.h>)
#include <GL/glew.h>

namespace engine {

std::string renderer_by_glew() {
    // It loads OpenGL first, and then looks for GLX's display, which this engine has none of.
    const GLenum result = glewInit();
    if ((result != GLEW_OK && result != GLEW_ERROR_NO_GLX_DISPLAY) || !glCreateBuffers) return "";
    return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

} // namespace engine
#else
std::string engine::renderer_by_glew() {
    return "";
}
#endif
