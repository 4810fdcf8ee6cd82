// What a glTF document says, as a model. Each part in a file of its own.
#pragma once

#include "animation_clips.hpp"
#include "gltf_document.hpp"
#include "model_pictures.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

/// A material with the numbers of the TEXCOORD sets that it calls 0 and 1.
struct GltfMaterial {
    Material material;
    std::vector<std::size_t> uv_sets;
};
/// materials[index]; without an index glTF's default material.
GltfMaterial read_gltf_material(const GltfDocument& document, std::optional<std::size_t> index,
                                ModelPictures& pictures, Losses& losses);

/// A primitive's triangles; an empty mesh if it has none. `uv_sets` as its material has them.
Mesh read_gltf_primitive(const GltfDocument& document, const GltfDocument::Json& primitive,
                         const std::vector<std::size_t>& uv_sets, Losses& losses);

/// The attributes of a primitive that is compressed with Draco, by name, and its indices.
struct DracoMesh {
    struct Attribute {
        std::size_t width = 0;
        std::vector<float> values;
    };
    std::map<std::string, Attribute> attributes;
    std::vector<std::uint32_t> indices;
};
DracoMesh read_draco(const GltfDocument& document, const GltfDocument::Json& extension);

/// All of them; `node_of_gltf` leads from glTF's nodes to the model's.
std::vector<AnimationClip> read_gltf_animations(const GltfDocument& document,
                                                const std::vector<std::size_t>& node_of_gltf,
                                                const std::vector<Node>& nodes);

/// KHR_lights_punctual's lights[index], without a node; nothing if it is of a kind that we don't know.
std::optional<Light> read_gltf_light(const GltfDocument& document, std::size_t index, Losses& losses);
/// cameras[index], looking down the -z of its node.
NamedCamera read_gltf_camera(const GltfDocument& document, std::size_t index);

/// Nothing if the file is of version 1.
std::optional<Model> read_gltf(const std::filesystem::path& file, const ReadingHooks& hooks);

} // namespace postfx::host
