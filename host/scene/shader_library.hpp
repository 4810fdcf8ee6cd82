// The scene's programs, put together from the pieces in shaders/scene so that each has just the outputs that
// are wanted. [GL thread]
#pragma once

#include <gl/objects.hpp>

#include <string>
#include <vector>

namespace postfx::host {

/// Location of every fragment output is its index: "color" first, then some of "normal", "emission",
/// "ambient".
using OutputNames = std::vector<std::string>;

gl::Program make_mesh_program(const OutputNames& outputs, bool textured);
gl::Program make_shadow_program();
gl::Program make_sky_program();
/// Several samples per pixel to one: light is averaged, depth and normal come from the nearest sample.
/// Samplers: binding 0 is depth, 1 + index the outputs.
gl::Program make_resolve_program(const OutputNames& outputs, int samples);

} // namespace postfx::host
