#include "memory_file.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

namespace postfx::host {

MemoryFile::MemoryFile(const std::string& content) : descriptor_(::memfd_create("model", MFD_CLOEXEC)) {
    const auto fail = [] {
        throw Error(fmt::format("can't keep what came through a pipe: {}", std::strerror(errno)));
    };
    if (descriptor_ < 0) fail();
    for (std::string_view rest = content; !rest.empty();) {
        const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            ::close(descriptor_);
            fail();
        }
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

MemoryFile::~MemoryFile() {
    ::close(descriptor_);
}

std::filesystem::path MemoryFile::path() const {
    return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_);
}

} // namespace postfx::host
