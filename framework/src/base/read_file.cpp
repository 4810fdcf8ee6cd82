#include "base/read_file.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace postfx {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& file, const std::string& message) {
    throw Error(Place{.file = input_name(file)}, message);
}

[[noreturn]] void fail_reading(const fs::path& file, int code) {
    fail(file, fmt::format("can't be read: {}", std::strerror(code)));
}

bool is_standard_input(const fs::path& file) {
    return file == "-";
}

/// The name of a process's descriptor, which is in no folder that the user thinks of: /dev/fd/3, /proc/self/fd/3.
bool names_descriptor(const fs::path& file) {
    const std::string folder = file.parent_path().string();
    return is_standard_input(file) || file == "/dev/stdin" || folder == "/dev/fd"
           || (folder.starts_with("/proc/") && folder.ends_with("/fd"));
}

/// `; did you mean "default.yaml"?` for a neighbour of the missing file.
std::string nearest_file(const fs::path& missing) {
    std::vector<std::string> neighbours;
    std::error_code failure;
    const fs::path folder = missing.has_parent_path() ? missing.parent_path() : fs::path(".");
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
         entry.increment(failure)) {
        neighbours.push_back(entry->path().filename().string());
    }
    return did_you_mean(missing.filename().string(), neighbours);
}

[[noreturn]] void fail_opening(const fs::path& file, int code) {
    std::error_code ignored;
    if (code == ENOENT && fs::is_symlink(file, ignored)) {
        fail(file,
             fmt::format("is a link to {}, which is not there", fs::read_symlink(file, ignored).string()));
    }
    if (code == ENOENT || code == ENOTDIR) fail(file, "no such file" + nearest_file(file));
    fail_reading(file, code);
}

/// An open file; standard input stays open for whoever else has it.
class InputDescriptor {
public:
    explicit InputDescriptor(const fs::path& file)
        : owned_(!is_standard_input(file)),
          descriptor_(owned_ ? ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY) : STDIN_FILENO) {
        if (descriptor_ < 0) fail_opening(file, errno);
    }
    ~InputDescriptor() {
        if (owned_) ::close(descriptor_);
    }
    InputDescriptor(const InputDescriptor&) = delete;
    InputDescriptor& operator=(const InputDescriptor&) = delete;

    struct stat status(const fs::path& file) const {
        struct stat status = {};
        if (::fstat(descriptor_, &status) != 0) fail_reading(file, errno);
        return status;
    }

    /// Up to `wanted` bytes behind those of `bytes`; false at the end.
    bool append(std::string& bytes, std::size_t wanted, const fs::path& file) const {
        const std::size_t before = bytes.size();
        bytes.resize(before + wanted);
        ssize_t count = 0;
        do {
            count = ::read(descriptor_, bytes.data() + before, wanted);
        } while (count < 0 && errno == EINTR);
        if (count < 0) fail_reading(file, errno);
        bytes.resize(before + static_cast<std::size_t>(count));
        return count > 0;
    }

private:
    bool owned_;
    int descriptor_;
};

void refuse_folder(const struct stat& status, const fs::path& file, std::string_view expected) {
    if (S_ISDIR(status.st_mode)) fail(file, fmt::format("is a directory, expected {}", expected));
}

/// Refuses what was emptied by an earlier reader: standard input, and a pipe that the shell made. A FIFO in a folder
/// may be filled again.
void take_once(const struct stat& status, const fs::path& file) {
    if (!names_descriptor(file) || (S_ISREG(status.st_mode) && !is_standard_input(file))) return;
    static std::mutex mutex;
    static std::map<std::pair<dev_t, ino_t>, std::string> taken;
    const std::scoped_lock lock(mutex);
    const auto [earlier, is_new] = taken.emplace(std::pair{status.st_dev, status.st_ino}, input_name(file));
    if (is_new) return;
    fail(file, fmt::format("was read before{}, and can be read only once",
                           earlier->second == input_name(file) ? "" : " as " + earlier->second));
}

std::string read_all(const InputDescriptor& input, const fs::path& file, std::size_t likely_bytes,
                     std::size_t max_bytes) {
    std::string bytes;
    bytes.reserve(std::min(likely_bytes, max_bytes) + 1);
    while (bytes.size() < max_bytes
           && input.append(bytes, std::min(chunk_bytes, max_bytes - bytes.size()), file)) {
    }
    return bytes;
}

std::string size_text(std::size_t bytes) {
    constexpr std::size_t kibibyte = 1024, mebibyte = kibibyte * 1024;
    if (bytes < kibibyte) return fmt::format("{} bytes", bytes);
    return bytes < 10 * mebibyte ? fmt::format("{} KiB", bytes / kibibyte)
                                 : fmt::format("{} MiB", bytes / mebibyte);
}

} // namespace

std::string read_file(const fs::path& file, std::size_t max_bytes, std::string_view expected) {
    const InputDescriptor input(file);
    const struct stat status = input.status(file);
    refuse_folder(status, file, expected);
    take_once(status, file);
    const std::size_t likely_bytes = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
    std::string bytes = read_all(input, file, likely_bytes, max_bytes + 1);
    if (bytes.size() > max_bytes) {
        fail(file, fmt::format("is larger than {}, expected {}", size_text(max_bytes), expected));
    }
    return bytes;
}

std::string read_start(const fs::path& file, std::size_t max_bytes, std::string_view expected) {
    if (is_stream(file)) return {};
    const InputDescriptor input(file);
    refuse_folder(input.status(file), file, expected);
    return read_all(input, file, max_bytes, max_bytes);
}

bool is_stream(const fs::path& file) {
    if (is_standard_input(file)) return true;
    struct stat status = {};
    return ::stat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

void expect_readable(const fs::path& file, std::string_view expected) {
    if (is_standard_input(file)) return;
    struct stat status = {};
    if (::stat(file.c_str(), &status) != 0) fail_opening(file, errno);
    refuse_folder(status, file, expected);
}

std::string input_name(const fs::path& file) {
    return is_standard_input(file) ? "standard input" : file.string();
}

fs::path folder_of(const fs::path& file) {
    return names_descriptor(file) ? fs::path() : file.parent_path();
}

} // namespace postfx
