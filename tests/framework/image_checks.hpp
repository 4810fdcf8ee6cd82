// What the tests of image files share.
#pragma once

#include "temporary_directory.hpp"

#include <image/files.hpp>
#include <postfx/error.hpp>

#include <catch2/catch.hpp>

#include <cstdlib>
#include <cstring>
#include <string>

namespace postfx::testing {

/// The message of the Error that `work` throws; it must be one line and name `file`.
template<class Work>
std::string error_of(const std::filesystem::path& file, Work work) {
    try {
        work();
    } catch (const Error& error) {
        const std::string text = error.what();
        INFO(text);
        CHECK(text.find(file.string()) != std::string::npos);
        CHECK(text.find('\n') == std::string::npos);
        CHECK(error.place().file == file.string());
        return text;
    }
    FAIL("no Error for " << file);
    return "";
}

inline std::string read_error(const std::filesystem::path& file) {
    return error_of(file, [&] { read_image(file); });
}

/// Every shorter beginning of `file` is refused; `step` bytes apart, up to `whole`, where its pixels end.
inline void check_truncated(const TemporaryDirectory& directory, const std::filesystem::path& file,
                            std::size_t whole, std::size_t step) {
    const std::string bytes = file_bytes(file);
    REQUIRE_NOTHROW(read_image(file));
    const std::filesystem::path cut = directory / ("cut" + file.extension().string());
    for (std::size_t size = 0; size < whole; size += step) {
        CAPTURE(size);
        put_bytes(cut, bytes.substr(0, size));
        read_error(cut);
    }
}

inline bool same_values(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels
           && std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

/// A picture that nobody here made, or "" (and a line that says so) where it is not there.
inline std::filesystem::path test_data(const std::string& name) {
    const char* folder = std::getenv("POSTFX_TEST_DATA");
    const std::filesystem::path root =
        folder ? folder : std::filesystem::path(POSTFX_SOURCE_DIRECTORY) / "../shared/data";
    const std::filesystem::path file = root / "images" / name;
    if (std::filesystem::exists(file)) return file;
    WARN("skipped: no " << name << " in " << root / "images"
                        << "; set POSTFX_TEST_DATA");
    return {};
}

} // namespace postfx::testing
