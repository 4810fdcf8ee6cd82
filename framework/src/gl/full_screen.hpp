// One triangle that covers the target, without buffers: glDrawArrays(GL_TRIANGLES, 0, 3).
#pragma once

#include <string_view>

namespace postfx::gl {

inline constexpr std::string_view full_screen_vertex_text = R"(#version 450 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

} // namespace postfx::gl
