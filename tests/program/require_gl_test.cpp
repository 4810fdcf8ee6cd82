// Without OpenGL a test is skipped; with POSTFX_REQUIRE_GL=1, as in CI, it fails: a context that we broke ourselves would
// be taken for a machine that has none.
#include "program.hpp"

using namespace postfx::testing;

namespace {

/// A test of this build, in an environment with these settings.
Outcome run_test(const std::string& name, std::vector<std::string> settings,
                 const std::string& cases = "~[.]") {
    std::vector<std::string> command = {"env", "-u", "POSTFX_REQUIRE_GL"};
    command.insert(command.end(), settings.begin(), settings.end());
    command.insert(command.end(), {POSTFX_BUILD_DIRECTORY "/tests/" + name, cases});
    return run_command(command);
}

const std::string no_driver = "__EGL_VENDOR_LIBRARY_FILENAMES=/absent.json";
const std::string required = "POSTFX_REQUIRE_GL=1";

} // namespace

TEST_CASE("a test that finds no context is skipped, or fails when one is required") {
    // Three main()s: two tests make the context themselves.
    const std::string test = GENERATE("folded_gl_test", "gl_gl_test", "scene_gl_test");
    CAPTURE(test);
    const Outcome skipped = run_test(test, {no_driver});
    CHECK(skipped.status == 77);
    CHECK_THAT(skipped.out, Catch::StartsWith("skipped: "));
    const Outcome failed = run_test(test, {no_driver, required});
    CHECK(failed.status == 1);
    CHECK_THAT(failed.out, Catch::StartsWith("failed, POSTFX_REQUIRE_GL is 1: "));
}

TEST_CASE("a case that can't open a window is left out, or fails when OpenGL is required") {
    const std::string name = "the window shows what render writes", nothing_installed = "PATH=/absent";
    const Outcome skipped = run_test("window_test", {nothing_installed}, name);
    CHECK(skipped.status == 0);
    CHECK_THAT(skipped.out, Catch::Contains("skipped: xvfb-run is not installed"));
    const Outcome failed = run_test("window_test", {nothing_installed, required}, name);
    CHECK(failed.status == 1);
    CHECK_THAT(failed.out, Catch::Contains("xvfb-run is not installed"));
}
