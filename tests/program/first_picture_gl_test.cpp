// The first picture of a size, of values, of a program: what is compiled for it, by what the program tells and by what
// the driver keeps.
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <sched.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

/// Empty caches of its own, that of the driver as well.
class Caches {
public:
    Outcome run(const std::vector<std::string>& arguments,
                const std::vector<std::string>& before = {}) const {
        std::vector<std::string> command = {"env", "XDG_CACHE_HOME=" + (directory_ / "ours").string(),
                                            "MESA_SHADER_CACHE_DIR=" + (directory_ / "driver").string()};
        command.insert(command.end(), before.begin(), before.end());
        command.emplace_back(POSTFX_BUILD_DIRECTORY "/postfx");
        command.insert(command.end(), arguments.begin(), arguments.end());
        return run_command(command);
    }
    Json programs(std::vector<std::string> arguments, const std::vector<std::string>& before = {}) const {
        arguments.insert(arguments.end(), {"--json", "--no-times"});
        const Outcome outcome = run(arguments, before);
        INFO(outcome.err);
        REQUIRE(outcome.status == 0);
        return Json::parse(outcome.out).at("programs");
    }
    std::ptrdiff_t files_of_driver() const {
        const std::filesystem::recursive_directory_iterator files(directory_ / "driver");
        return std::count_if(begin(files), end(files),
                             [](const auto& entry) { return entry.is_regular_file(); });
    }

private:
    TemporaryDirectory directory_;
};

/// A number of its own for each pixel.
void put_picture(const std::filesystem::path& file, int width, int height) {
    std::string bytes = "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
    for (int i = 0; i < 3 * width * height; ++i)
        bytes += static_cast<char>(i * 37 % 251);
    put_bytes(file, bytes);
}

/// The command that lets a program run on one core only; empty where there is but one.
std::vector<std::string> on_one_core() {
    cpu_set_t cores;
    REQUIRE(::sched_getaffinity(0, sizeof(cores), &cores) == 0);
    int first = 0;
    while (!CPU_ISSET(first, &cores))
        ++first;
    if (CPU_COUNT(&cores) == 1) return {};
    return {"taskset", "-c", std::to_string(first)};
}

/// Without decisions: all its passes are drawn.
const std::vector<std::string> plain_chain = {"--effect", "bloom",  "--effect", "chromatic_aberration",
                                              "--effect", "tonemap"};

std::vector<std::string> apply(const std::filesystem::path& from, const std::filesystem::path& to,
                               const std::vector<std::string>& chain) {
    std::vector<std::string> arguments = {"apply", "--color", from, "-o", to};
    arguments.insert(arguments.end(), chain.begin(), chain.end());
    return arguments;
}

} // namespace

TEST_CASE("Once compiled, the programs of a scene's chain serve every size and every value") {
    const Caches caches;
    const TemporaryDirectory directory;
    const std::string out = directory / "out.png";
    const auto render = [&](const std::string& size, const std::string& chain) {
        return caches.programs({"render", "still_life", "--size", size, "--chain", chain, "-o", out});
    };
    const std::string changed = directory / "changed.yaml";
    put_bytes(changed, "effects:\n"
                       "  - depth_of_field: {f_number: 1.7, max_circle_of_confusion: 0.021}\n"
                       "  - bloom: {intensity: 0.23, tint: [0.9, 0.8, 0.7]}\n"
                       "  - chromatic_aberration: {strength: 0.004}\n"
                       "  - vignette: {strength: 0.31}\n"
                       "  - tonemap: {exposure: 0.7}\n"
                       "  - grain: {amount: 0.02}\n");
    const Json first = render("96x54", "cinematic");
    CHECK(first.at("all") > 10);
    CHECK(first.at("compiled") == first.at("all"));
    const Json again = render("96x54", "cinematic");
    CHECK(again.at("all") == first.at("all"));
    for (const Json& later : {again, render("121x67", "cinematic"), render("96x54", changed)}) {
        CHECK(later.at("compiled") == 0);
        CHECK(later.at("warmed") == 0);
    }
}

TEST_CASE("Once compiled, the programs of a photograph's chain serve every size and every value") {
    const Caches caches;
    const TemporaryDirectory directory;
    put_picture(directory / "a.ppm", 61, 43);
    put_picture(directory / "b.ppm", 53, 77);
    const std::string out = directory / "out.png";
    const Json first = caches.programs(apply(directory / "a.ppm", out, plain_chain));
    CHECK(first.at("compiled") == first.at("all"));
    const std::vector<std::string> changed = {"--effect", "bloom: {intensity: 0.2}",
                                              "--effect", "chromatic_aberration: {strength: 0.003}",
                                              "--effect", "tonemap: {exposure: 1}"};
    const Json later = caches.programs(apply(directory / "b.ppm", out, changed));
    CHECK(later.at("all") == first.at("all"));
    CHECK(later.at("compiled") == 0);
}

TEST_CASE("A second thread compiles what is drawn and nothing else, and changes no picture") {
    const std::vector<std::string> one_core = on_one_core();
    if (one_core.empty()) {
        WARN("skipped: this machine has one core");
        return;
    }
    const TemporaryDirectory directory;
    for (const int width : {64, 67}) { // drivers compile for powers of two apart
        put_picture(directory / "in.ppm", width, 40);
        const Caches with, without;
        const Json two = with.programs(apply(directory / "in.ppm", directory / "two.png", plain_chain));
        const Json one =
            without.programs(apply(directory / "in.ppm", directory / "one.png", plain_chain), one_core);
        CHECK(one.at("warmed") == 0);
        CHECK(one.at("compiled") == two.at("compiled"));
        CHECK(file_bytes(directory / "one.png") == file_bytes(directory / "two.png"));
        // Mesa writes its files on threads of its own, and what it has not written at the end of the process is lost: the
        // next one compiles it again. What only one of the two compiles would come up every time.
        for (int i = 0; i < 5 && with.files_of_driver() != without.files_of_driver(); ++i) {
            with.programs(apply(directory / "in.ppm", directory / "two.png", plain_chain));
            without.programs(apply(directory / "in.ppm", directory / "one.png", plain_chain), one_core);
        }
        CHECK(with.files_of_driver() > 0);
        CHECK(with.files_of_driver() == without.files_of_driver());
    }
}

TEST_CASE("A shader that does not compile is one message, on however many cores") {
    const TemporaryDirectory directory;
    put_picture(directory / "in.ppm", 30, 20);
    const std::filesystem::path plugins = directory / "plugins";
    std::filesystem::create_directory(plugins);
    for (const char* name : {"postfx_fixture_tint.so", "postfx_fixture_broken_shader.so"})
        std::filesystem::copy(std::filesystem::path(POSTFX_FIXTURES) / name, plugins / name);
    const std::vector<std::string> chain = {"--effect",      "tint",         "--effect",
                                            "broken_shader", "--plugin-dir", plugins};
    const std::vector<std::string> arguments = apply(directory / "in.ppm", directory / "out.png", chain);
    const Caches with, without;
    const Outcome two = with.run(arguments), one = without.run(arguments, on_one_core());
    check_refused(two, "broken_shader.glsl:4");
    CHECK(two.err == one.err);
}
