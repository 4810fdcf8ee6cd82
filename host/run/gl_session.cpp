#include "gl_session.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace postfx::host {

void tell_debug_messages() {
    if (!debug_build) return;
    for (const std::string& message : gl::take_debug_messages()) {
        fmt::print(stderr, "postfx: OpenGL: {}\n", message);
    }
}

} // namespace postfx::host
