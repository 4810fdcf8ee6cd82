// postfx new: the folder it makes builds out of tree against this build, and passes its tests. Also what an
// installation holds.
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <set>

namespace fs = std::filesystem;
using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

void check_success(const Outcome& outcome) {
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.status == 0);
}

} // namespace

TEST_CASE("new makes a folder under the effect's name") {
    const TemporaryDirectory scratch;
    const Outcome made = run_program({"new", "film_tint"}, scratch.path());
    check_success(made);
    CHECK(made.err.empty());
    CHECK_THAT(made.out, Catch::Contains("-Dpostfx_DIR=" POSTFX_BUILD_DIRECTORY));
    std::set<std::string> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(scratch.path() / "film_tint")) {
        files.insert(entry.path().filename().string());
        const std::string text = file_bytes(entry.path());
        for (const char* placeholder : {"my_effect", "MyEffect", "MY_EFFECT"})
            CHECK_THAT(text, !Catch::Contains(placeholder));
    }
    CHECK(files
          == std::set<std::string>{"CMakeLists.txt", "README.md", "film_tint.cpp", "film_tint.glsl",
                                   "reference.cpp", "test.cpp"});
    CHECK_THAT(file_bytes(scratch.path() / "film_tint/film_tint.glsl"), Catch::Contains("FilmTintParams"));
}

TEST_CASE("new refuses names and folders, and makes nothing") {
    const TemporaryDirectory scratch;
    for (const char* name : {"Tint", "2tint", "film-tint", "film__tint", "film_", "gl_tint", ""}) {
        INFO(name);
        check_refused(run_program({"new", name}, scratch.path()), "can't name an effect");
    }
    check_refused(run_program({"new", "float"}, scratch.path()), "another meaning");
    check_refused(run_program({"new", "test"}, scratch.path()), "another meaning");
    std::ofstream(scratch.path() / "taken") << "a file";
    check_refused(run_program({"new", "taken"}, scratch.path()), "exists already");
    check_refused(run_program({"new", "tint", "--dir", "taken/tint"}, scratch.path()), "can't be made");
    fs::remove(scratch.path() / "taken");
    CHECK(fs::is_empty(scratch.path()));
}

TEST_CASE("new warns when there is such an effect already") {
    const TemporaryDirectory scratch;
    const std::string taken = Json::parse(run_program({"list", "effects", "--json"}).out).at(0).at("id");
    const Outcome made = run_program({"new", taken, "--dir", "mine/"}, scratch.path());
    check_success(made);
    CHECK_THAT(made.err, Catch::Contains("there is an effect " + taken + " already"));
    CHECK(fs::exists(scratch.path() / "mine" / (taken + ".cpp")));
}

TEST_CASE("the new effect builds out of tree, passes its tests and is found", "[slow]") {
    const TemporaryDirectory scratch;
    const auto run = [&](const std::vector<std::string>& command) {
        return run_command(command, scratch.path());
    };
    check_success(run_program({"new", "film_tint"}, scratch.path()));
    check_success(run({"cmake", "-S", "film_tint", "-B", "build", "-G", "Ninja",
                       "-Dpostfx_DIR=" POSTFX_BUILD_DIRECTORY, "-DCMAKE_CXX_COMPILER=" POSTFX_CXX_COMPILER}));
    check_success(run({"cmake", "--build", "build"}));
    const Outcome tested = run({"ctest", "--test-dir", "build", "--output-on-failure"});
    check_success(tested);
    CHECK_THAT(tested.out, Catch::Contains("100% tests passed, 0 tests failed out of 1"));

    const Outcome described = run_program(
        {"describe", "film_tint", "--json", "--plugin-dir", "build/postfx_plugins"}, scratch.path());
    check_success(described);
    CHECK(Json::parse(described.out)["parameters"].size() == 2);
}

TEST_CASE("an installation finds its own effects and data", "[slow]") {
    const TemporaryDirectory scratch;
    const std::string prefix = (scratch / "prefix").string();
    check_success(run_command({"cmake", "--install", POSTFX_BUILD_DIRECTORY, "--prefix", prefix}));
    const std::string program = prefix + "/bin/postfx";
    for (const auto& [what, key] : {std::pair{"effects", "module"}, std::pair{"chains", "path"}}) {
        const Outcome listed = run_command({program, "list", what, "--json"});
        check_success(listed);
        const Json items = Json::parse(listed.out);
        REQUIRE_FALSE(items.empty());
        for (const Json& item : items)
            CHECK_THAT(item[key].get<std::string>(), Catch::StartsWith(prefix + "/"));
    }
    // Of every effect that says how it is studied, that lies beside its module.
    std::set<std::string> entries, installed;
    for (const fs::directory_entry& effect : fs::directory_iterator(POSTFX_SOURCE_DIRECTORY "/plugins")) {
        if (fs::exists(effect.path() / "study.yaml"))
            entries.insert("postfx_" + effect.path().filename().string() + ".study.yaml");
    }
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(prefix + "/lib/postfx")) {
        if (file.path().extension() == ".yaml") installed.insert(file.path().filename().string());
    }
    CHECK(installed == entries);
    CHECK_FALSE(installed.empty());
    const Outcome made = run_command({program, "new", "film_tint"}, scratch.path());
    check_success(made);
    CHECK_THAT(made.out, Catch::Contains("-Dpostfx_DIR=" + prefix + "/lib/cmake/postfx"));
}
