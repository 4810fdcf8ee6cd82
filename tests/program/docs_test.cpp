// docs/reference is what the code says now.
#include "program.hpp"

#include <map>

namespace fs = std::filesystem;
using namespace postfx::testing;

namespace {

std::map<std::string, std::string> files_below(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file())
            files[fs::relative(entry.path(), folder).string()] = file_bytes(entry.path());
    }
    return files;
}

} // namespace

TEST_CASE("docs/reference is up to date") {
    const TemporaryDirectory scratch;
    REQUIRE(run_program({"docs", "--out", (scratch / "reference").string()}).status == 0);
    const auto fresh = files_below(scratch.path() / "reference");
    const auto committed = files_below(POSTFX_SOURCE_DIRECTORY "/docs/reference");
    for (const auto& [name, text] : fresh) {
        INFO("docs/reference/" << name << ": run ./run docs --out docs/reference");
        REQUIRE(committed.count(name) == 1);
        CHECK((committed.at(name) == text));
    }
    for (const auto& [name, text] : committed) {
        INFO("docs/reference/" << name << " is not made by postfx docs");
        CHECK(fresh.count(name) == 1);
    }
}

TEST_CASE("docs removes pages of effects that are gone, and no others") {
    const TemporaryDirectory scratch;
    REQUIRE(run_program({"docs", "--out", scratch.path()}).status == 0);
    const std::string made = file_bytes(scratch.path() / "README.md");
    std::ofstream(scratch.path() / "effects/gone.md") << made;
    std::ofstream(scratch.path() / "effects/own.md") << "written by hand\n";
    REQUIRE(run_program({"docs", "--out", scratch.path()}).status == 0);
    CHECK_FALSE(fs::exists(scratch.path() / "effects/gone.md"));
    CHECK(fs::exists(scratch.path() / "effects/own.md"));
}
