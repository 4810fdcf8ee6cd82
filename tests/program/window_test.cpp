// `postfx view` under a virtual display: it opens, draws, obeys --frames and leaves a picture.
#include "program.hpp"

#include <image/files.hpp>
#include <image/metrics.hpp>

#include <catch2/catch.hpp>

#include <cstdlib>
#include <string>

using namespace postfx;
using namespace postfx::testing;

namespace {

const std::string program = std::string(POSTFX_BUILD_DIRECTORY) + "/postfx";

/// Is the command there that this Debian package has? If not, the test case can't go on.
bool has_command(const std::string& command, const std::string& package) {
    if (std::system(("command -v " + command + " > /dev/null 2>&1").c_str()) == 0) return true;
    skip_case(command + " is not installed (package " + package + ")");
    return false;
}

bool can_open_windows() {
    return has_command("xvfb-run", "xvfb");
}

bool can_press_keys() {
    return can_open_windows() && has_command("xdotool", "xdotool");
}

Outcome under_display(std::vector<std::string> command) {
    command.insert(command.begin(), {"xvfb-run", "-a", "-s", "-screen 0 800x600x24"});
    return run_command(command);
}

/// `postfx view` in `directory`, with these keys pressed one after the other when it has run for so long.
Outcome view_with_keys(const std::string& arguments, int seconds, const std::string& keys,
                       const std::filesystem::path& directory) {
    // Keys reach a window that has the focus; without a window manager somebody has to give it.
    const std::string script =
        program + (" view " + arguments)
        + " & window=$(xdotool search --sync --onlyvisible --name postfx | head -n 1); "
          "xdotool windowfocus --sync $window; sleep "
        + std::to_string(seconds) + "; for key in " + keys
        + "; do xdotool key $key; sleep 0.5; done; wait $!";
    return run_command({"xvfb-run", "-a", "-s", "-screen 0 800x600x24", "timeout", "60", "sh", "-c", script},
                       directory);
}

} // namespace

TEST_CASE("the window shows what render writes") {
    if (!can_open_windows()) return;
    const TemporaryDirectory scratch;
    const std::vector<std::string> common = {"cornell", "--chain", "cinematic", "--size", "320x180"};
    std::vector<std::string> view = {program, "view", "--frames", "1", "-o", (scratch / "view.png").string()};
    std::vector<std::string> render = {
        program, "render", "-q", "--samples", "1", "-o", (scratch / "render.png").string()};
    view.insert(view.end(), common.begin(), common.end());
    render.insert(render.end(), common.begin(), common.end());
    const Outcome viewed = under_display(view);
    INFO(viewed.err);
    REQUIRE(viewed.status == 0);
    CHECK(viewed.out.find("F12") != std::string::npos); // the keys are told
    REQUIRE(run_command(render).status == 0);
    const Difference difference =
        compare(read_image(scratch / "view.png").image, read_image((scratch / "render.png").string()).image);
    // The same driver, scene, time and noise; GLX may choose another visual but draws into our own targets.
    CHECK(difference.psnr > 50);
}

TEST_CASE("the window's picture goes to standard output, and text elsewhere then") {
    if (!can_open_windows()) return;
    const TemporaryDirectory scratch;
    const std::string view = program + " view cornell --chain none --size 64x36 --frames 1 -o ";
    // Redirected within: xvfb-run joins both streams.
    const auto viewed = [&](const std::string& rest) {
        return run_command({"xvfb-run", "-a", "sh", "-c", view + rest}, scratch.path());
    };
    REQUIRE(viewed("file.png > text").status == 0);
    REQUIRE(viewed("- --format png > piped 2> told").status == 0);
    CHECK(read_image(scratch / "piped").image.values == read_image(scratch / "file.png").image.values);
    CHECK(file_bytes(scratch / "told").find("F12") != std::string::npos);
    CHECK(viewed("- > piped").status != 0);
}

TEST_CASE("keys toggle effects, help, save a picture, pause and leave") {
    if (!can_press_keys()) return;
    const TemporaryDirectory scratch;
    const Outcome outcome = view_with_keys("cornell --size 160x90", 0, "h 2 2 p F12 Escape", scratch.path());
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.status == 0);
    const std::size_t first_help = outcome.out.find("F12");
    CHECK(outcome.out.find("F12", first_help + 1) != std::string::npos);
    const std::size_t off = outcome.out.find("bloom is off"), on = outcome.out.find("bloom is on");
    REQUIRE(off != std::string::npos);
    CHECK(on > off);
    CHECK(on != std::string::npos);
    CHECK_THAT(outcome.out, Catch::Contains("wrote postfx_0000.png"));
    CHECK(read_image(scratch / "postfx_0000.png").image.width == 160);
}

TEST_CASE("without a display the window says what to do") {
    const Outcome outcome =
        run_command({"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", program, "view", "cornell"});
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find("postfx render") != std::string::npos);
}

TEST_CASE("a budget is kept while the window is open") {
    if (!can_press_keys()) return;
    const TemporaryDirectory scratch;
    // No device is as quick as these curves say: the levels that they allow have to come down, and to fade.
    put_bytes(scratch / "curves.json", R"({
        "device": "made up", "driver": "1", "clock": "none", "made_by": "a test",
        "base": {"fixed_ms": 0.0001, "ms_per_megapixel": 0},
        "effects": {"ssao": [
            {"level": "low", "fixed_ms": 0.0001, "ms_per_megapixel": 0, "error": 0.2, "step_to_next": 0.02},
            {"level": "high", "fixed_ms": 0.0005, "ms_per_megapixel": 0, "error": 0.1, "step_to_next": 0}]}})");
    const Outcome outcome = view_with_keys("cornell --effect ssao --effect tonemap --size 160x90 --curves "
                                           "curves.json --by-curves --budget ms=0.001",
                                           5, "r t r Escape", scratch.path());
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Catch::Contains("  ssao     high")); // to begin with
    const std::size_t kept = outcome.out.find("budget: ms 0.001; error 0.2; ssao low\n");
    CHECK(kept != std::string::npos);
    // After the T key errors are those of the scene.
    CHECK(outcome.out.find("budget: ms 0.001; error 0.0", kept) != std::string::npos);
    CHECK_THAT(outcome.out, Catch::Contains("; 1 change so far\n  over the budget: nothing is cheaper\n"));
}
