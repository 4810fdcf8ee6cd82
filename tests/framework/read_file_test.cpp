// Files, pipes and devices, read whole.
#include <catch2/catch.hpp>

#include <base/read_file.hpp>
#include <postfx/error.hpp>
#include <temporary_directory.hpp>

#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fs = std::filesystem;
using namespace postfx;
using namespace postfx::testing;

namespace {

std::string error_of(const fs::path& file, std::size_t max_bytes = 1000) {
    try {
        read_file(file, max_bytes, "a chain");
    } catch (const Error& error) {
        return error.message();
    }
    return "no error";
}

/// A pipe that holds `bytes`, read at /dev/fd/N, as a shell's <(...) gives it.
class Pipe {
public:
    explicit Pipe(const std::string& bytes) {
        REQUIRE(::pipe(ends_) == 0);
        REQUIRE(::write(ends_[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
        ::close(ends_[1]);
    }
    ~Pipe() { ::close(ends_[0]); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    int descriptor() const { return ends_[0]; }
    fs::path name() const { return "/dev/fd/" + std::to_string(ends_[0]); }

private:
    int ends_[2] = {};
};

/// Puts a descriptor in the place of standard input while it lives.
class AsStandardInput {
public:
    explicit AsStandardInput(int descriptor) : before_(::dup(STDIN_FILENO)) {
        ::dup2(descriptor, STDIN_FILENO);
    }
    ~AsStandardInput() {
        ::dup2(before_, STDIN_FILENO);
        ::close(before_);
    }
    AsStandardInput(const AsStandardInput&) = delete;
    AsStandardInput& operator=(const AsStandardInput&) = delete;

private:
    int before_;
};

} // namespace

TEST_CASE("a file is read whole, up to its limit") {
    const TemporaryDirectory folder;
    put_bytes(folder / "a", std::string("a\0b\n", 4));
    put_bytes(folder / "empty", "");
    CHECK(read_file(folder / "a", 4, "a chain") == std::string("a\0b\n", 4));
    CHECK(read_file(folder / "empty", 4, "a chain").empty());
    CHECK(error_of(folder / "a", 3) == "is larger than 3 bytes, expected a chain");
    CHECK(read_start(folder / "a", 3, "a chain") == std::string("a\0b", 3));
}

TEST_CASE("a missing file is told by its nearest neighbour, other trouble by its cause") {
    const TemporaryDirectory folder;
    put_bytes(folder / "default.yaml", "");
    fs::create_symlink("nowhere", folder / "link");
    CHECK(error_of(folder / "defalt.yaml") == "no such file; did you mean \"default.yaml\"?");
    CHECK(error_of(folder / "default.yaml/x") == "no such file");
    CHECK(error_of(folder / "link") == "is a link to nowhere, which is not there");
    CHECK(error_of(folder.path()) == "is a directory, expected a chain");
    CHECK_THROWS_AS(expect_readable(folder / "link", "a chain"), Error);
    CHECK_NOTHROW(expect_readable(folder / "default.yaml", "a chain"));
    if (::geteuid() == 0) return; // permissions do not bind the superuser
    fs::permissions(folder / "default.yaml", fs::perms::none);
    CHECK(error_of(folder / "default.yaml") == "can't be read: Permission denied");
}

TEST_CASE("what never ends is read up to the limit") {
    CHECK(error_of("/dev/zero", 5000) == "is larger than 4 KiB, expected a chain");
    CHECK(read_file("/dev/null", 10, "a chain").empty());
}

TEST_CASE("a pipe is read to its end, and once") {
    const Pipe pipe("effects: []");
    CHECK(is_stream(pipe.name()));
    CHECK(read_start(pipe.name(), 4, "a chain").empty());
    CHECK(read_file(pipe.name(), 100, "a chain") == "effects: []");
    CHECK(error_of(pipe.name()) == "was read before, and can be read only once");
}

TEST_CASE("a FIFO in a folder may be filled again") {
    const TemporaryDirectory folder;
    REQUIRE(::mkfifo((folder / "fifo").c_str(), 0600) == 0);
    for (const std::string& bytes : {std::string("first"), std::string(300000, 'x')}) {
        std::thread writer([&] { put_bytes(folder / "fifo", bytes); });
        CHECK(read_file(folder / "fifo", 1 << 20, "a chain") == bytes);
        writer.join();
    }
}

TEST_CASE("- is standard input, which a second reader is refused under any name") {
    const Pipe pipe("bytes");
    const AsStandardInput input(pipe.descriptor());
    CHECK(is_stream("-"));
    CHECK(input_name("-") == "standard input");
    CHECK(read_file("-", 100, "a chain") == "bytes");
    CHECK(error_of("-") == "was read before, and can be read only once");
    CHECK(error_of("/dev/stdin") == "was read before as standard input, and can be read only once");
}

TEST_CASE("file names in a file count from its folder, in a pipe from the current one") {
    CHECK(folder_of("a/b.yaml") == "a");
    CHECK(folder_of("b.yaml").empty());
    for (const char* stream : {"-", "/dev/stdin", "/dev/fd/63", "/proc/self/fd/3"})
        CHECK(folder_of(stream).empty());
}
