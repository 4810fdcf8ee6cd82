// Reading models.
#pragma once

#include "scene.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace postfx::host {

/// What whoever reads a model may want to know or do meanwhile.
struct ReadingHooks {
    /// Before a file of so many bytes is read.
    std::function<void(std::uintmax_t bytes)> opening = [](std::uintmax_t) {};
    /// Every picture, once; what it returns is what materials hold.
    std::function<PicturePtr(PicturePtr)> picture = [](PicturePtr picture) { return picture; };
};

/// Read a model file: glTF 2.0 by ourselves, everything else that assimp knows by assimp. Throws Error naming the file
/// and, where something is of a kind that we can't read, that.
Model load_model(const std::filesystem::path& file, const ReadingHooks& hooks = {});
/// Does the file's ending belong to a format that load_model knows?
bool is_model_file(const std::filesystem::path& file);

/// Put the model into a scene, below the node `parent` or beside all others, with its lights and cameras.
void add_model(Scene& scene, const Model& model, std::optional<std::size_t> parent = std::nullopt);

} // namespace postfx::host
