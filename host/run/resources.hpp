// Files that come with the program: chains and scenes by name.
#pragma once

#include <postfx/chain.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host {

/// The folder that holds `configs/`, `templates/`: POSTFX_DATA_DIR, else <prefix>/share/postfx beside an
/// installed program, else the source tree that the program was built from. Throws Error when none is there.
std::filesystem::path data_directory();

/// Names of the chains in configs/chains/, sorted.
std::vector<std::string> chain_names();

/// "-" and what is or looks like a path as it is, readable or not; else the file of a name in configs/chains/. Throws
/// Error with the nearest name.
std::filesystem::path find_chain(const std::string& name_or_path);

/// A chain by its file or its name in configs/chains/; it may include those that are there.
Chain read_chain_named(const std::string& name_or_path, const Catalog& catalog);

/// Where programs and other things that can be made again are kept: $XDG_CACHE_HOME/postfx or
/// ~/.cache/postfx; empty when there is no home.
std::filesystem::path cache_directory();

} // namespace postfx::host
