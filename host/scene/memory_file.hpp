// A file without a place: what came through a pipe, for readers that want a file that they can seek in.
#pragma once

#include <filesystem>
#include <string>

namespace postfx::host {

class MemoryFile {
public:
    /// Throws Error when the system gives none.
    explicit MemoryFile(const std::string& content);
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    /// While this lives, also for processes that it starts. folder_of() takes it for a file of the current folder.
    std::filesystem::path path() const;

private:
    int descriptor_ = -1;
};

} // namespace postfx::host
