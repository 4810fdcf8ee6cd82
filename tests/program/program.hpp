// Running the built program, and others, as a user would.
#pragma once

#include <catch2/catch.hpp>

#include <temporary_directory.hpp>
#include <testing.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <cstdlib>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace postfx::testing {

struct Outcome {
    int status = -1; ///< of the exit; 128 + the signal when it was killed
    std::string out, err;
};

/// Run a command in `directory` and wait. It sees no plugins, data or settings of the user or the test.
inline Outcome run_command(const std::vector<std::string>& command,
                           const std::filesystem::path& directory = ".") {
    const TemporaryDirectory scratch;
    const std::string out = scratch / "out", err = scratch / "err", home = scratch / "home";
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("can't start a process");
    if (child == 0) {
        for (const char* variable : {"POSTFX_PLUGIN_PATH", "POSTFX_DATA_DIR"})
            ::unsetenv(variable);
        ::setenv("XDG_DATA_HOME", home.c_str(), 1);
        const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT, 0600);
        const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT, 0600);
        const bool ready =
            ::dup2(out_file, 1) >= 0 && ::dup2(err_file, 2) >= 0 && ::chdir(directory.c_str()) == 0;
        std::vector<char*> arguments;
        for (const std::string& word : command)
            arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        if (ready) ::execvp(arguments[0], arguments.data());
        ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_bytes(out),
            file_bytes(err)};
}

/// Run the program that the build made.
inline Outcome run_program(std::vector<std::string> arguments, const std::filesystem::path& directory = ".") {
    arguments.insert(arguments.begin(), POSTFX_BUILD_DIRECTORY "/postfx");
    return run_command(arguments, directory);
}

/// Says that the test case can't go on here for want of OpenGL or a window; it fails if they are required.
inline void skip_case(const std::string& why) {
    if (requires_gl()) FAIL(why);
    WARN("skipped: " << why);
}

/// It ended with status 2 and one line on stderr that has `words`, and printed nothing else.
inline void check_refused(const Outcome& outcome, const std::string& words) {
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("postfx: "));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK_THAT(outcome.err, Catch::Contains(words));
}

} // namespace postfx::testing
