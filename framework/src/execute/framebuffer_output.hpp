// The picture into a framebuffer of the host's. [GL thread]
#pragma once

#include <gl/objects.hpp>

#include <postfx/executor.hpp>

namespace postfx {

/// Throws Error where nothing can be drawn: no framebuffer of that name, an incomplete one, one of integers, a rectangle
/// without pixels.
void check_output(const OutputTarget& output);

class FramebufferOutput {
public:
    FramebufferOutput();
    /// Write the texture of that size into the rectangle, sample for sample where their sizes agree. Wants the state of
    /// set_pass_state() and a vertex array.
    void draw(GLuint picture, int width, int height, const OutputTarget& output) const;

private:
    gl::Program program_;
    gl::Sampler nearest_, linear_;
};

} // namespace postfx
