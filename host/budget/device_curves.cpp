#include "device_curves.hpp"

#include "run/resources.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <optional>
#include <vector>

namespace fs = std::filesystem;

namespace postfx::host {
namespace {

/// What file systems take: "llvmpipe (LLVM 15)" -> "llvmpipe-llvm-15".
std::string slug(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c))) {
            result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        } else if (!result.empty() && result.back() != '-') {
            result += '-';
        }
    }
    while (result.ends_with('-'))
        result.pop_back();
    return result;
}

/// Without what drivers add: "llvmpipe (LLVM 15)" -> "llvmpipe", "GeForce/PCIe/SSE2" -> "GeForce".
std::string plain_name(const std::string& device) {
    std::string name = device.substr(0, device.find_first_of("(/"));
    while (name.ends_with(' '))
        name.pop_back();
    return name;
}

fs::path shipped_directory() {
    return data_directory() / "configs/curves";
}

std::vector<fs::path> shipped_files() {
    std::vector<fs::path> files;
    std::error_code none; // no folder, no files
    for (const fs::directory_entry& entry : fs::directory_iterator(shipped_directory(), none)) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::optional<FoundCurves> kept_curves(const gl::DeviceInfo& device) {
    if (cache_directory().empty()) return std::nullopt;
    const fs::path file = kept_curves_file(device);
    if (!fs::exists(file)) return std::nullopt;
    return FoundCurves{read_curves(file), file, ""};
}

} // namespace

FoundCurves shipped_curves(const gl::DeviceInfo& device) {
    std::optional<FoundCurves> same, software, any;
    for (const fs::path& file : shipped_files()) {
        FoundCurves found{read_curves(file), file, ""};
        found.note =
            fmt::format("times were measured on {}; `postfx calibrate` measures them on this device, {}",
                        found.curves.device, device.renderer);
        const std::string name = plain_name(found.curves.device);
        if (name == plain_name(device.renderer) && !same) same = found;
        if (name == "llvmpipe" && !software) software = found;
        if (!any) any = std::move(found);
    }
    if (same) return *same;
    if (software) return *software;
    if (any) return *any;
    throw Error(fmt::format("there are no curves of what levels cost (looked in {}); `postfx study` measures "
                            "them, --curves names a file",
                            shipped_directory().string()));
}

FoundCurves find_curves(const fs::path& named) {
    if (!named.empty()) return {read_curves(named), named, ""};
    const gl::DeviceInfo device = gl::current_device();
    const std::optional<FoundCurves> kept = kept_curves(device);
    return kept ? *kept : shipped_curves(device);
}

fs::path kept_curves_file(const gl::DeviceInfo& device) {
    if (cache_directory().empty()) throw Error("there is no home for a cache; name a file with --output");
    return cache_directory() / "curves" / (slug(device.renderer + " " + device.version) + ".json");
}

void write_curves(const fs::path& file, const Curves& curves) {
    std::error_code error;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
    const fs::path unfinished = file.string() + ".part";
    std::ofstream stream(unfinished, std::ios::binary);
    stream << curves_json(curves);
    stream.close();
    if (!stream) throw Error(Place{.file = unfinished.string()}, "can't be written");
    fs::rename(unfinished, file, error);
    if (error)
        throw Error(Place{.file = file.string()}, fmt::format("can't be written: {}", error.message()));
}

} // namespace postfx::host
