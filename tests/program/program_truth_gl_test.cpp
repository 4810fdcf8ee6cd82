// postfx truth from outside: what it tells, what it refuses, and that a stopped one goes on.
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <string>

using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> truth(const TemporaryDirectory& folder, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"truth", "cornell", "ssao", "--store", folder / "store"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

Json json_of(const Outcome& outcome) {
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return Json::parse(outcome.out);
}

} // namespace

TEST_CASE("truth tells what it is, how well it knows, and writes the picture") {
    const TemporaryDirectory folder;
    const std::string picture = folder / "a.pfm";
    const Outcome outcome = run_program(
        truth(folder, {"--set", "radius=0.5", "--size", "32x24", "--samples", "8", "-o", picture, "--json"}));
    const Json json = json_of(outcome);
    CHECK(json["effect"] == "ssao");
    CHECK(json["kind"] == "scene");
    CHECK(json["size"] == "32x24");
    CHECK(json["samples"] == 8);
    CHECK(json["own_error"] > 0);
    CHECK(json["own_error"] < 0.1);
    CHECK_THAT(json["description"].get<std::string>(), Catch::Contains("8 cosine-weighted rays"));
    CHECK(json["output"] == picture);
    CHECK(file_bytes(picture).size() > 32 * 24 * 12);
    CHECK(std::filesystem::is_regular_file(json["sums"].get<std::string>()));

    // The same sums to standard output, whatever else is told going elsewhere.
    const Outcome piped = run_program(truth(
        folder, {"--set", "radius=0.5", "--size", "32x24", "--samples", "8", "-o", "-", "--format", "pfm"}));
    CHECK(piped.status == 0);
    CHECK(piped.out == file_bytes(picture));
    CHECK_THAT(piped.err, Catch::Contains("own error"));

    const Outcome spoken =
        run_program(truth(folder, {"--set", "radius=0.5", "--size", "32x24", "--samples", "8"}));
    CHECK(spoken.status == 0);
    CHECK_THAT(spoken.out, Catch::Contains("own error"));
}

TEST_CASE("what is asked for wrongly is refused") {
    const TemporaryDirectory folder;
    check_refused(run_program(truth(folder, {"--set", "radius"})), "NAME=VALUE");
    check_refused(run_program(truth(folder, {"--set", "raduis=1"})), "radius");
    check_refused(run_program(truth(folder, {"--samples", "7"})), "even");
    check_refused(run_program({"truth", "cornell", "vignette", "--kind", "layer"}), "it has scene");
    check_refused(run_program(truth(folder, {"-o", "a.gif"})), ".exr");
    check_refused(run_program(truth(folder, {"-o", "-"})), "--format is needed");
    check_refused(run_program({"truth", "cornell", "ssao: {radius: 1}", "--set", "radius=2"}), "not both");
    const Outcome unknown = run_program({"truth", "cornell", "tint", "--plugin-dir", POSTFX_FIXTURES});
    CHECK(unknown.status == 2);
    CHECK_THAT(unknown.err, Catch::Contains("tint has no truth") && Catch::Contains("ssao (scene)"));
}

TEST_CASE("an interrupted truth is continued to the picture that it would have been") {
    const TemporaryDirectory folder;
    const std::vector<std::string> size = {"--size", "96x96", "--samples", "512"};
    const auto with = [&](const std::string& name, const std::string& store) {
        std::vector<std::string> arguments = truth(folder, size);
        arguments.insert(arguments.end(), {"--store", folder / store, "-o", folder / name, "--json"});
        arguments.erase(arguments.begin() + 3, arguments.begin() + 5);
        return arguments;
    };
    const Json whole = json_of(run_program(with("whole.pfm", "one")));

    // Interrupted as soon as it runs; quick machines may be done with a part of it, slow ones with none.
    std::vector<std::string> interrupted = {
        "timeout", "--preserve-status", "-s", "INT", "0.5", POSTFX_BUILD_DIRECTORY "/postfx"};
    for (const std::string& argument : with("part.pfm", "two"))
        interrupted.push_back(argument);
    const Outcome stopped = run_command(interrupted);
    INFO(stopped.err);
    const bool was_stopped =
        stopped.status == 130 || stopped.status == 128 + 2; // before it listened: by the signal
    CHECK((was_stopped || stopped.status == 0));

    const Json continued = json_of(run_program(with("continued.pfm", "two")));
    CHECK(continued["samples"] == 512);
    CHECK(continued["own_error"] == whole["own_error"]);
    CHECK(file_bytes(folder / "continued.pfm") == file_bytes(folder / "whole.pfm"));
}
