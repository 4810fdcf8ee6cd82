// Which layer of an EXR file serves which role, by the conventions of the programs that write them. Names only.
#pragma once

#include <image/exr_layers.hpp>
#include <image/role.hpp>

#include <optional>
#include <string>
#include <vector>

namespace postfx::formats {

struct LayerWish {
    Role role = Role::color;
    std::string layer{};  ///< by name; "" = by convention
    std::string view{};   ///< "" = the default one
    std::string beside{}; ///< the layer that serves as colour: what was rendered with it comes first
};

/// A layer, or why there is none.
struct LayerChoice {
    std::optional<ExrLayer> layer{};
    std::string refusal{};
    std::vector<std::string> warnings{}; ///< what was taken though its name doesn't say so
};

LayerChoice choose_layer(const ExrContents& contents, const LayerWish& wish);

/// True or false if the layer's name, or who wrote the file, says that its normals are in world or in view space.
/// `program`: "Arnold", "Blender", ... or "".
std::optional<bool> has_world_normals(const ExrLayer& layer, const std::string& program);

} // namespace postfx::formats
