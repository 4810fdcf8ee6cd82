// Which curves a budget is met by: measured on this device, or those that come along.
#pragma once

#include <gl/context.hpp>

#include <postfx/curves.hpp>

#include <filesystem>
#include <string>

namespace postfx::host {

struct FoundCurves {
    Curves curves;
    std::filesystem::path file;
    std::string note; ///< what to think of their times; "" when they were measured on this device
};

/// The file itself, if one is named. Else, for the current OpenGL context's device: what `postfx calibrate` kept, else
/// what comes along for a device of its name, else for llvmpipe, else for any. Throws Error when there is none.
FoundCurves find_curves(const std::filesystem::path& named);
/// The same without what was measured here: where errors come from.
FoundCurves shipped_curves(const gl::DeviceInfo& device);

/// Where `postfx calibrate` keeps the device's curves. Throws Error when there is no home for a cache.
std::filesystem::path kept_curves_file(const gl::DeviceInfo& device);
/// All of the file or nothing. Throws Error.
void write_curves(const std::filesystem::path& file, const Curves& curves);

} // namespace postfx::host
