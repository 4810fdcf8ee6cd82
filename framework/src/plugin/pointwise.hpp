// Can this GLSL be a compose function? Decided by reading it, never by asking its author.
#pragma once

#include <string>
#include <string_view>

namespace postfx {

/// Why `glsl` could reach anything but its own pixel and its arguments, as "line 12: uses dFdx"; empty when
/// it can't. Forbidden: gl_*, uniform/buffer/shared/layout/in/out and variables at file scope, image and
/// sampler types other than sampler2D arguments, derivatives and what needs them implicitly (texture()),
/// discard, image and atomic functions, preprocessor lines other than #include and #define of a name in
/// capitals, and whatever could make this reading differ from a compiler's. In the assembled program the
/// chain's colour is declared after these functions, so what this scan lets through still can't name it.
std::string why_not_pointwise(std::string_view glsl);

} // namespace postfx
