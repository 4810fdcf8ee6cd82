// The scene's programs, put together from the pieces in shaders/scene so that each has just the outputs that
// are wanted. [GL thread]
#pragma once

#include "scene.hpp"

#include <gl/objects.hpp>

#include <compare>
#include <string>
#include <vector>

namespace postfx::host {

/// Location of every fragment output is its index: "color" first, then some of "normal", "emission",
/// "ambient".
using OutputNames = std::vector<std::string>;

/// What the shader has to know of a light beforehand; where it is and how bright changes by frame.
struct LightCode {
    Light::Kind kind;
    int shadow_layer = -1; ///< -1: casts none
    bool ranged = false;   ///< it has an end
};

/// What the shader has to know of a surface beforehand, so that what a surface does not have costs nothing.
struct SurfaceCode {
    bool textured = false;
    bool placed = false; ///< some texture is not read at the vertices' first uv as it is
    bool extra = false;  ///< its vertices have a second uv and an opacity
    bool normal_map = false;
    bool metal_rough = false;
    bool occluded = false; ///< has an occlusion texture
    bool cut = false;      ///< is not there where its alpha is low
    bool unlit = false;

    auto operator<=>(const SurfaceCode&) const = default;
};
SurfaceCode surface_code(const Material& material, bool extra);

/// One call per light, rather than a loop over all kinds: software rasterizers run every branch of a loop's
/// body.
gl::Program make_mesh_program(const OutputNames& outputs, const SurfaceCode& surface,
                              const std::vector<LightCode>& lights);
/// Only depth, at exactly the same depth as make_mesh_program.
gl::Program make_depth_program();
gl::Program make_shadow_program();
/// Of materials that are cut by their alpha; reads their block and diffuse texture.
gl::Program make_cut_shadow_program();
gl::Program make_sky_program();
/// Several samples per pixel to one: light is averaged, depth and normal come from the nearest sample.
/// Samplers: binding 0 is depth, 1 + index the outputs. Without `depth`, which normals need, only light.
gl::Program make_resolve_program(const OutputNames& outputs, int samples, bool depth);

} // namespace postfx::host
