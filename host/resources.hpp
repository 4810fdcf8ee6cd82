// Files that come with the program: chains and scenes by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host {

/// The folder that holds `configs/`, `templates/`: POSTFX_DATA_DIR, else <prefix>/share/postfx beside an
/// installed program, else the source tree that the program was built from. Throws Error when none is there.
std::filesystem::path data_directory();

/// Names of the YAML files in configs/<kind>/, sorted; kind is "chains" or "scenes".
std::vector<std::string> config_names(const std::string& kind);

/// A path that exists as it is, or a name in configs/<kind>/. Throws Error with the nearest name.
std::filesystem::path find_config(const std::string& kind, const std::string& name_or_path);

/// Where programs and other things that can be made again are kept: $XDG_CACHE_HOME/postfx or
/// ~/.cache/postfx; empty when there is no home.
std::filesystem::path cache_directory();

} // namespace postfx::host
