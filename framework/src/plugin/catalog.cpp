#include <plugin/declarations.hpp>

#include <postfx/catalog.hpp>
#include <postfx/error.hpp>

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace fs = std::filesystem;

namespace postfx {
namespace {

fs::path installed_below(const fs::path& prefix) {
    return prefix / fmt::format("lib/postfx/plugins-{}", POSTFX_ABI_MAJOR);
}

/// The folder of the shared library that this code is in; "" where it was linked into the program.
fs::path library_directory() {
    Dl_info info{};
    link_map* map = nullptr;
    if (dladdr1(reinterpret_cast<const void*>(&library_directory), &info, reinterpret_cast<void**>(&map),
                RTLD_DL_LINKMAP)
            == 0
        || !map) {
        return {};
    }
    // The program's own entry has no name; a relative one would be looked up in the current directory.
    const fs::path file = map->l_name;
    return file.is_absolute() ? file.parent_path() : fs::path();
}

/// Where a build tree and an installation have the plugins of what is in `directory`.
std::vector<fs::path> plugins_beside(const fs::path& directory) {
    return {directory / "postfx_plugins", installed_below(directory.parent_path())};
}

/// Directories of the user, the installation and the build tree, in the order in which they are asked.
std::vector<fs::path> standard_directories() {
    std::vector<fs::path> directories;
    if (const char* data = secure_getenv("XDG_DATA_HOME"); data && *data) {
        directories.push_back(fs::path(data) / "postfx/plugins");
    } else if (const char* home = secure_getenv("HOME"); home && *home) {
        directories.push_back(fs::path(home) / ".local/share/postfx/plugins");
    }
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const fs::path& place : {program, library_directory()}) {
        if (place.empty()) continue;
        for (fs::path& directory : plugins_beside(place))
            directories.push_back(std::move(directory));
    }
    directories.push_back(installed_below(POSTFX_INSTALL_PREFIX));
    return directories;
}

std::vector<fs::path> path_variable() {
    std::vector<fs::path> directories;
    const char* variable = secure_getenv("POSTFX_PLUGIN_PATH");
    std::string_view rest = variable ? variable : "";
    while (!rest.empty()) {
        const std::size_t colon = std::min(rest.find(':'), rest.size());
        directories.emplace_back(rest.substr(0, colon));
        rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
    return directories;
}

/// Why code from this file or directory must not be run; empty when it may.
std::string why_unsafe(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return "can't be read";
    if (status.st_mode & S_IWOTH) return "is writable by everybody";
    if (status.st_uid != 0 && status.st_uid != ::geteuid()) return "belongs to another user";
    return "";
}

/// Does the file end before what its headers promise? Then it was copied or written half, and dlopen
/// would not fail but die of SIGBUS. Anything else that may be wrong with it is dlopen's to say.
bool is_cut(const fs::path& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const auto size = static_cast<std::uint64_t>(file.tellg());
    ElfW(Ehdr) header{};
    file.seekg(0);
    file.read(reinterpret_cast<char*>(&header), sizeof(header));
    if (!file || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return false;
    if (header.e_shoff + std::uint64_t{header.e_shnum} * header.e_shentsize > size) return true;
    file.seekg(static_cast<std::streamoff>(header.e_phoff));
    for (int i = 0; i < header.e_phnum; ++i) {
        ElfW(Phdr) segment{};
        file.read(reinterpret_cast<char*>(&segment), sizeof(segment));
        if (!file || (segment.p_type == PT_LOAD && segment.p_offset + segment.p_filesz > size)) return true;
    }
    return false;
}

} // namespace

std::string_view ParameterInfo::kind_name() const {
    switch (kind) {
    case ParameterKind::number:
        return "float";
    case ParameterKind::integer:
        return "int";
    case ParameterKind::toggle:
        return "bool";
    case ParameterKind::choice:
        return "choice";
    case ParameterKind::color:
        return "color";
    }
    return "";
}

std::optional<std::size_t> EffectInfo::find_parameter(std::string_view parameter_id) const {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (parameters[i].id == parameter_id) return i;
    }
    return std::nullopt;
}

std::vector<Value> EffectInfo::default_values() const {
    std::vector<Value> values;
    for (const ParameterInfo& parameter : parameters)
        values.push_back(parameter.default_value);
    return values;
}

const SourceInfo* EffectInfo::find_source(std::string_view name) const {
    for (const SourceInfo& source : sources) {
        if (source.name == name) return &source;
    }
    return nullptr;
}

Catalog Catalog::discover(const std::vector<fs::path>& first) {
    Catalog catalog;
    for (const fs::path& directory : first) {
        // Named on the command line: a relative path is what the user typed, and a missing one is their
        // mistake.
        std::error_code missing;
        if (!fs::is_directory(directory, missing))
            throw Error(Place{.file = directory.string()}, "no such plugin directory");
        catalog.scan(fs::absolute(directory));
    }
    for (const fs::path& directory : path_variable()) {
        if (directory.is_absolute()) {
            catalog.scan(directory);
        } else {
            catalog.notes_.push_back(fmt::format(
                "POSTFX_PLUGIN_PATH: \"{}\" is refused, not an absolute path", directory.string()));
        }
    }
    for (const fs::path& directory : standard_directories())
        catalog.scan(directory);
    if (catalog.effects_.empty()) {
        for (const fs::path& directory : catalog.searched_)
            catalog.notes_.push_back(fmt::format("no effect was found in {}", directory.string()));
    }
    return catalog;
}

void Catalog::scan(const fs::path& directory) {
    if (std::find(searched_.begin(), searched_.end(), directory) != searched_.end()) return;
    searched_.push_back(directory);
    std::error_code missing;
    if (!fs::is_directory(directory, missing)) return;
    if (const std::string unsafe = why_unsafe(directory); !unsafe.empty()) {
        notes_.push_back(fmt::format("{}: refused, the directory {}", directory.string(), unsafe));
        return;
    }
    std::vector<fs::path> modules;
    std::error_code unreadable;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory, unreadable)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("postfx_") && name.ends_with(".so")) modules.push_back(entry.path());
    }
    if (unreadable) {
        notes_.push_back(fmt::format("{}: {}", directory.string(), unreadable.message()));
    }
    std::sort(modules.begin(), modules.end());
    for (const fs::path& module : modules) {
        try {
            load(module);
        } catch (const Error& error) {
            notes_.emplace_back(error.what());
        }
    }
}

void Catalog::load(const fs::path& module) {
    const fs::path path = fs::absolute(module);
    const Place place{.file = path.string()};
    std::error_code missing;
    if (!fs::is_regular_file(path, missing)) throw Error(place, "no such plugin file");
    if (const std::string unsafe = why_unsafe(path); !unsafe.empty())
        throw Error(place, "refused, the file " + unsafe);
    if (is_cut(path)) throw Error(place, "not a loadable plugin: the file is cut short");
    // Never closed: unloading a library is the one thing about plugins that keeps going wrong (dlclose may
    // keep it, unmap code that still runs, or run destructors twice), and a module of constants costs only
    // its pages.
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw Error(place, fmt::format("not a loadable plugin: {}", dlerror()));
    const auto* found = static_cast<const postfx_module*>(dlsym(library, POSTFX_MODULE_SYMBOL));
    if (!found) {
        throw Error(place, fmt::format("not a postfx plugin of major version {}: it does not export {}",
                                       POSTFX_ABI_MAJOR, POSTFX_MODULE_SYMBOL));
    }
    add(*found, path);
}

void Catalog::add(const postfx_module& declared, const fs::path& origin) {
    const auto module = copy_abi<postfx_module>(&declared);
    if (module.abi_major != POSTFX_ABI_MAJOR) {
        throw Error(
            Place{.file = origin.string()},
            fmt::format("has ABI major version {}, this host speaks {}", module.abi_major, POSTFX_ABI_MAJOR));
    }
    const std::vector<SourceInfo> sources = read_sources(module, origin);
    std::optional<Error> first_problem;
    for (std::uint32_t i = 0; i < module.effect_count; ++i) {
        try {
            if (!module.effects[i]) {
                throw Error(Place{.file = origin.string()},
                            fmt::format("effect {} of its list is missing", i));
            }
            add(std::make_shared<const EffectInfo>(read_effect(*module.effects[i], sources, origin)));
        } catch (const Error& error) {
            // A bad effect takes no good one with it.
            if (first_problem) {
                notes_.emplace_back(error.what());
            } else {
                first_problem = error;
            }
        }
    }
    if (first_problem) throw *first_problem;
}

void Catalog::add(EffectPtr effect) {
    const auto at = std::lower_bound(effects_.begin(), effects_.end(), effect->id,
                                     [](const EffectPtr& e, const std::string& id) { return e->id < id; });
    if (at == effects_.end() || (*at)->id != effect->id) {
        effects_.insert(at, std::move(effect));
        return;
    }
    std::error_code unknown;
    if (fs::equivalent((*at)->module_path, effect->module_path, unknown)) return; // a directory named twice
    notes_.push_back(fmt::format("{}: {} is shadowed by {}", effect->module_path.string(), effect->id,
                                 (*at)->module_path.string()));
}

EffectPtr Catalog::find(std::string_view id) const {
    const auto at =
        std::lower_bound(effects_.begin(), effects_.end(), id,
                         [](const EffectPtr& e, std::string_view wanted) { return e->id < wanted; });
    return at != effects_.end() && (*at)->id == id ? *at : nullptr;
}

std::vector<std::string> Catalog::ids() const {
    std::vector<std::string> ids;
    for (const EffectPtr& effect : effects_)
        ids.push_back(effect->id);
    return ids;
}

} // namespace postfx
