// Models are read in a process of their own, since what reads other people's files may crash, hang or want all memory.
#pragma once

#include "scene/scene.hpp"

#include <filesystem>

namespace postfx::host {

/// As load_model, by this program started anew as `postfx read-model FILE`, with limits on time and memory that grow with
/// the sizes of the files that it opens. Throws Error naming the file, also when the process died.
Model read_model_in_child(const std::filesystem::path& file);

/// What that process does: reads the model and writes it to its standard output. Returns when all is written.
void read_model_for_parent(const std::filesystem::path& file);

} // namespace postfx::host
