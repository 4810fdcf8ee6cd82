// The parts of reading a scene file that know one section each.
#pragma once

#include "assets.hpp"
#include "generators.hpp"
#include "model.hpp"
#include "scene.hpp"
#include "yaml.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

inline constexpr Range any_length{-1e6, 1e6};
inline constexpr Range positive{1e-6, 1e6};
inline constexpr Range from_zero{0, 1e6};
inline constexpr Range share{0, 1};
inline constexpr Range degrees{-1e6, 1e6};

/// What nodes refer to by name.
struct Library {
    std::optional<Terrain> terrain;
    std::map<std::string, std::size_t> paths, materials;
    std::map<std::string, Model> models; ///< read already, by file
    ModelSource read_model;
};

/// One of these names, or an error with the nearest. `what` is "material", "path", ...
std::size_t find_named(const YamlValue& name, const std::map<std::string, std::size_t>& names,
                       const std::string& what);

Material read_material(const std::string& name, const YamlValue& value);
Terrain read_terrain(const YamlValue& value);
Path read_path(const YamlValue& value, const std::optional<Terrain>& terrain);
Surroundings read_surroundings(const std::optional<YamlValue>& background,
                               const std::optional<YamlValue>& ambient);
Light read_light(const YamlValue& value);
Animation read_animation(const YamlValue& value, const Library& library);

/// `mesh:` of a node with its `material:` and `materials:`, unless it is a model. May add materials.
std::vector<Part> read_mesh(const YamlValue& mesh, const std::optional<YamlValue>& material,
                            const std::optional<YamlValue>& slots, Scene& scene, Library& library);
/// If `mesh:` is a model: put its nodes below `node`, with its own materials or with that one. A scene file has lights of
/// its own: the model's are a loss.
void place_model(const YamlValue& mesh, const std::optional<YamlValue>& material, std::size_t node,
                 Scene& scene, Library& library);

} // namespace postfx::host
