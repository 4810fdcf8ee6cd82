// Small text files, read whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace postfx {

/// The content of a regular file of at most `max_bytes`. Throws Error with the file's name and the reason:
/// not there (and the nearest name that is), no regular file, unreadable, too large.
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes);

} // namespace postfx
