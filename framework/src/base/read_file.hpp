// What a user names as input, read whole: files, pipes, standard input.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace postfx {

/// The bytes of a file, a FIFO, a device (/dev/stdin, /dev/fd/63) or, named "-", of standard input. No more than
/// `max_bytes` + 1 are ever read, however long a pipe or /dev/zero goes on. `expected` says what the file ought to be:
/// "a chain", "an image". Throws Error with the name and the reason: not there (and the nearest name that is), a folder,
/// unreadable, larger than `max_bytes`; and for a pipe without a name in a folder, standard input above all, that was
/// read before, as nothing is left in it. An empty file is an empty string.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes, std::string_view expected);

/// The first bytes of a regular file, at most `max_bytes`; nothing of a pipe, whose bytes would be lost to the next
/// reader. Throws Error as read_file() does, but for the size.
std::string read_start(const std::filesystem::path& file, std::size_t max_bytes, std::string_view expected);

/// Is `file` a thing whose bytes come once: standard input, a pipe, a terminal? False for what is not there.
bool is_stream(const std::filesystem::path& file);

/// Throws Error, as read_file() does, when there is nothing at `file` or a folder.
void expect_readable(const std::filesystem::path& file, std::string_view expected);

/// As messages name it: "standard input" for "-", else the path.
std::string input_name(const std::filesystem::path& file);

/// The folder from which file names in `file` count: its own, or "" (the current one) when the name is only that of an
/// open descriptor ("-", /dev/stdin, /dev/fd/63).
std::filesystem::path folder_of(const std::filesystem::path& file);

} // namespace postfx
