// Models for assimp, which goes by names: under the name that their content should have.
#pragma once

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <filesystem>
#include <string>

namespace postfx::host {

/// assimp's reading of a model by what the file holds, whatever it is called. `content` is the whole file when that can't
/// be read again, as it is a pipe; else "". `steps` as for Importer::ReadFile, which keeps the scene and the error.
const aiScene* read_by_content(Assimp::Importer& importer, const std::filesystem::path& file,
                               const std::string& content, unsigned steps);

} // namespace postfx::host
