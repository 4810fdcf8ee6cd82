// Files that scenes refer to: pictures for textures, models.
#pragma once

#include "scene.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host {

/// Throws Error naming the file when it is missing or no picture.
PicturePtr load_picture(const std::filesystem::path& file, bool srgb);
/// The same from the bytes of a file; `name` is for messages.
PicturePtr decode_picture(const std::uint8_t* bytes, std::size_t size, bool srgb, const std::string& name);

struct ModelPart {
    std::shared_ptr<const Mesh> mesh;
    std::size_t material; ///< index into Model::materials
};
struct Model {
    std::vector<Material> materials;
    std::vector<ModelPart> parts; ///< in the model's own space, its hierarchy applied
};
/// Read a model file with assimp (glTF, OBJ, PLY, ...). Throws Error naming the file, or the texture it
/// lacks. Its format is told by its content. `content` is the whole file when that can't be read again, as it is a
/// pipe; else "".
Model load_model(const std::filesystem::path& file, const std::string& content = {});
/// Does the file's ending belong to a format that load_model knows?
bool is_model_file(const std::filesystem::path& file);

} // namespace postfx::host
