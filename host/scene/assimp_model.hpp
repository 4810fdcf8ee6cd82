// Models of other formats than glTF 2.0, by assimp.
#pragma once

#include "model.hpp"

#include <filesystem>

namespace postfx::host {

Model read_with_assimp(const std::filesystem::path& file, const ReadingHooks& hooks);

} // namespace postfx::host
