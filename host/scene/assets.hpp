// Pictures for textures.
#pragma once

#include "material.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace postfx::host {

/// Throws Error naming the file when it is missing or no picture.
PicturePtr load_picture(const std::filesystem::path& file, bool srgb);
/// The same from the bytes of a file; `name` is for messages.
PicturePtr decode_picture(const std::uint8_t* bytes, std::size_t size, bool srgb, const std::string& name);

} // namespace postfx::host
