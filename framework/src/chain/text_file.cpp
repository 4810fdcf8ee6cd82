#include "chain/text_file.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

namespace postfx {
namespace {

namespace fs = std::filesystem;

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

void expect_regular_file(const fs::path& file) {
    const Place place{.file = file.string()};
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (status.type() == fs::file_type::not_found) throw Error(place, "no such file" + nearest_file(file));
    if (failure) throw Error(place, "can't be read: " + failure.message());
    if (fs::is_directory(status)) throw Error(place, "is a directory, expected a file");
    if (!fs::is_regular_file(status)) throw Error(place, "is no regular file");
}

} // namespace

std::string read_text_file(const fs::path& file, std::size_t max_bytes) {
    expect_regular_file(file);
    const Place place{.file = file.string()};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Error(place, fmt::format("can't be read: {}", std::strerror(errno)));

    std::string text(max_bytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad()) throw Error(place, fmt::format("can't be read: {}", std::strerror(errno)));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > max_bytes) {
        throw Error(place, fmt::format("is larger than {} KiB, expected a chain", max_bytes / 1024));
    }
    return text;
}

} // namespace postfx
