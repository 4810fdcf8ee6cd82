// The program's OpenGL context without a window.
#pragma once

#include <gl/context.hpp>

namespace postfx::host {

#ifdef NDEBUG
constexpr bool debug_build = false;
#else
constexpr bool debug_build = true;
#endif

/// Prints on stderr what OpenGL had to say above notifications (debug builds only).
void tell_debug_messages();

/// A headless context, current while it lives. In debug builds OpenGL's messages are told at the end.
class GlSession {
public:
    GlSession() : context_(debug_build) {}
    ~GlSession() { tell_debug_messages(); }
    GlSession(const GlSession&) = delete;
    GlSession& operator=(const GlSession&) = delete;

    const gl::DeviceInfo& device() const { return context_.device(); }

private:
    gl::HeadlessContext context_;
};

} // namespace postfx::host
