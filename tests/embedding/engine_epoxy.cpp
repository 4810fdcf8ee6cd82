#include "engine.hpp"

#if __has_include(<epoxy/gl.h>)
#include <epoxy/gl.h>

std::string engine::renderer_by_epoxy() {
    return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}
#else
std::string engine::renderer_by_epoxy() {
    return "";
}
#endif
