#include "resources.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace fs = std::filesystem;

namespace postfx::host {

fs::path data_directory() {
    std::vector<fs::path> candidates;
    if (const char* directory = std::getenv("POSTFX_DATA_DIR")) candidates.emplace_back(directory);
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    candidates.push_back(program.parent_path() / "share/postfx");
    candidates.emplace_back(POSTFX_SOURCE_DIRECTORY);
    for (const fs::path& candidate : candidates) {
        if (fs::is_directory(candidate / "configs")) return candidate;
    }
    throw Error(fmt::format("no folder with configs/ found (looked in {} and {}); set POSTFX_DATA_DIR",
                            candidates.front().string(), candidates.back().string()));
}

std::vector<std::string> chain_names() {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(data_directory() / "configs/chains")) {
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

fs::path find_chain(const std::string& name_or_path) {
    const bool looks_like_path = name_or_path == "-" || name_or_path.find('/') != std::string::npos
                                 || fs::path(name_or_path).has_extension();
    if (looks_like_path || (fs::exists(name_or_path) && !fs::is_directory(name_or_path))) return name_or_path;
    fs::path named = data_directory() / "configs/chains" / (name_or_path + ".yaml");
    if (fs::is_regular_file(named)) return named;
    throw Error(fmt::format("no chain \"{}\"{} (postfx list chains tells them all)", name_or_path,
                            did_you_mean(name_or_path, chain_names())));
}

Chain read_chain_named(const std::string& name_or_path, const Catalog& catalog) {
    return read_chain(find_chain(name_or_path), catalog, {data_directory() / "configs/chains"});
}

fs::path cache_directory() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "postfx";
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache/postfx";
    return {};
}

} // namespace postfx::host
