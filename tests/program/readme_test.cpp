// The README's own commands, in a fresh clone and in the README's order. Building all of the program takes minutes, so
// this runs with ./test --long (POSTFX_LONG=1) only.
#include "program.hpp"

#include <image/files.hpp>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <sstream>

namespace fs = std::filesystem;
using namespace postfx;
using namespace postfx::testing;

namespace {

/// The commands of a text, as they stand: indented lines that begin with one of `programs`, without what is said beside
/// them.
std::vector<std::string> commands(const std::string& text, const std::vector<std::string>& programs) {
    std::vector<std::string> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t start = line.find_first_not_of(' ');
        if (start == std::string::npos || start == 0) continue;
        std::string command = line.substr(start, line.find("  #") - start);
        command.erase(command.find_last_not_of(' ') + 1);
        const std::string program = command.substr(0, command.find(' '));
        if (std::find(programs.begin(), programs.end(), program) != programs.end()) found.push_back(command);
    }
    return found;
}

/// A clone of this repository's HEAD, under a name with a blank in it.
class Clone {
public:
    Clone() {
        const Outcome cloned =
            run_command({"git", "clone", "--quiet", POSTFX_SOURCE_DIRECTORY, folder().string()});
        INFO(cloned.err);
        REQUIRE(cloned.status == 0);
        fs::create_directory(scratch_ / "home");
        // The reader's own pictures.
        write_image(folder() / "photo.jpg", Image(64, 48, 3, 0.25f), {.kind = "png"});
        write_image(folder() / "a.png", Image(64, 48, 3, 0.25f));
        write_image(folder() / "b.png", Image(64, 48, 3, 0.5f));
    }

    fs::path folder() const { return scratch_ / "post fx"; }

    Outcome run(const std::string& command) const {
        // Objects of an earlier walk are found although it was in another folder.
        const std::string settings = "export HOME='" + (scratch_ / "home").string()
                                     + "' CCACHE_NOHASHDIR=1 CCACHE_DIR='" + ccache_folder()
                                     + "' CCACHE_BASEDIR=\"$PWD\"; ";
        return run_command({"bash", "-c", settings + command}, folder());
    }

    /// The command does what it says: it ends well, but for those that end with another status when all is well.
    Outcome walk(const std::string& command, int status = 0) const {
        std::cout << command << std::endl;
        Outcome outcome = run(command);
        INFO(command << "\n" << outcome.out << outcome.err);
        CHECK(outcome.status == status);
        return outcome;
    }

private:
    static std::string ccache_folder() {
        if (const char* folder = std::getenv("CCACHE_DIR")) return folder;
        const char* home = std::getenv("HOME");
        return std::string(home ? home : "/tmp") + "/.cache/ccache";
    }

    TemporaryDirectory scratch_;
};

bool is_wanted() {
    if (const char* longer = std::getenv("POSTFX_LONG"); longer == nullptr || std::string(longer) != "1") {
        std::cout << "skipped: the README's walk builds all of postfx again; ./test --long does\n";
        return false;
    }
    if (run_command({"git", "-C", POSTFX_SOURCE_DIRECTORY, "rev-parse", "HEAD"}).status != 0) {
        std::cout << "skipped: this is no git checkout that could be cloned\n";
        return false;
    }
    return true;
}

/// A study's truths take an hour as the README has them; a small one goes the same way.
std::string smaller(const std::string& command) {
    if (!command.starts_with("./run study")) return command;
    return command
           + " --scene cornell --size 32x18 --time-size 64x36 --small-time-size 32x18 --samples 2 --rounds 1"
             " --seconds 0.1 --no-growth";
}

/// A window stays until somebody closes it.
std::string closing_itself(const std::string& command) {
    if (!command.starts_with("./run view")) return command;
    return "xvfb-run -a -s '-screen 0 1280x720x24' " + command + " --frames 2";
}

int status_when_well(const std::string& command) {
    return command.starts_with("./run diff") ? 1 : 0; // they differ
}

} // namespace

TEST_CASE("the README's commands work in a fresh clone, in its order", "[slow]") {
    if (!is_wanted()) return;
    const Clone clone;
    // ./test would build and run all tests, this one among them.
    int count = 0;
    for (const std::string& command :
         commands(file_bytes(clone.folder() / "README.md"), {"./run", "./test", "cmake"})) {
        if (command.starts_with("./test")) continue;
        ++count;
        const Outcome outcome = clone.walk(closing_itself(smaller(command)), status_when_well(command));
        if (!command.starts_with("./run new")) continue;
        const std::vector<std::string> next = commands(outcome.out, {"cmake", "ctest"});
        CHECK(next.size() == 3);
        for (const std::string& step : next) {
            const Outcome stepped = clone.walk(step);
            if (step.starts_with("ctest"))
                CHECK_THAT(stepped.out, Catch::Contains("100% tests passed, 0 tests failed out of 1"));
        }
    }
    CHECK(count == 12);
    for (const char* made : {"out/still_life.png", "glow.png", "out.png", "study/index.html"}) {
        INFO(made);
        CHECK(fs::exists(clone.folder() / made));
    }
    const Outcome installed = clone.run("~/.local/bin/postfx list effects --json");
    CHECK(installed.status == 0);
    CHECK_THAT(installed.out, Catch::Contains("bloom"));
}
