// What is skipped, shown and measured: --no-skip, explain --measure and skips.
#include "program.hpp"

#include <testing.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace fs = std::filesystem;
using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

Json json_of(const std::vector<std::string>& arguments) {
    const Outcome outcome = run_program(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return Json::parse(outcome.out);
}

std::vector<std::string> effect_ids() {
    std::vector<std::string> ids;
    for (const Json& effect : json_of({"list", "effects", "--json"}))
        ids.push_back(effect["id"]);
    return ids;
}

std::size_t skipped_in(const Json& report) {
    const Json& effects = report["effects"];
    return static_cast<std::size_t>(std::count_if(
        effects.begin(), effects.end(), [](const Json& effect) { return effect["status"] == "skipped"; }));
}

/// Nothing in it but background, so that whatever needs a surface is not called for.
fs::path empty_scene(const TemporaryDirectory& folder) {
    const fs::path file = folder.path() / "nothing.yaml";
    std::ofstream(file) << "description: nothing\nbackground: [0.2, 0.3, 0.4]\n";
    return file;
}

} // namespace

TEST_CASE("with --no-skip everything that is enabled runs") {
    const TemporaryDirectory scratch;
    const std::string scene = empty_scene(scratch);
    const Json as_is = json_of({"explain", scene, "--chain", "default", "--json"});
    const Json all = json_of({"explain", scene, "--chain", "default", "--json", "--no-skip"});
    CHECK(skipped_in(as_is) > 0);
    CHECK(skipped_in(all) == 0);

    const std::string picture = scratch / "picture.png";
    const Json rendered = json_of(
        {"render", scene, "--chain", "default", "--size", "48x32", "--no-skip", "--json", "-o", picture});
    CHECK(skipped_in(rendered) == 0);
    // Without depth effects lack something: those can't be run.
    const Outcome applied = run_program({"apply", "--color", picture, "--chain", "default", "--no-skip",
                                         "--json", "-o", scratch / "applied.png"});
    CHECK(applied.status == 0);
    for (const Json& effect : Json::parse(applied.out)["effects"]) {
        INFO(effect.dump());
        CHECK((effect["status"] != "skipped" || effect["kind"] == "lacks"));
    }
}

TEST_CASE("explain --measure tells what skipping saves") {
    const TemporaryDirectory scratch;
    const std::string scene = empty_scene(scratch);
    const std::vector<std::string> command = {"explain", scene,       "--chain", "default",   "--size",
                                              "96x64",   "--measure", "--json",  "--samples", "3"};
    const Json json = json_of(command);
    const Json& measured = json["measured"];
    CHECK(measured["rounds"] == 3);
    CHECK(measured["same"] == false);
    CHECK(measured["copy_ms"].get<double>() > 0);
    CHECK(measured["as_is"]["attachments"].size() < measured["no_skip"]["attachments"].size());
    CHECK(measured["saved"]["texture_bytes"].get<std::int64_t>()
          == measured["no_skip"]["texture_bytes"].get<std::int64_t>()
                 - measured["as_is"]["texture_bytes"].get<std::int64_t>());
    CHECK(measured["saved"]["texture_bytes"].get<std::int64_t>() > 0);
    CHECK(measured["as_is"]["ms"].get<double>() > measured["as_is"]["chain_ms"].get<double>());

    std::vector<std::string> in_words = command;
    in_words.erase(std::find(in_words.begin(), in_words.end(), "--json"));
    CHECK_THAT(run_program(in_words).out, Catch::Contains("skipping saves"));
    CHECK_THAT(
        run_program({"explain", scene, "--chain", "none", "--size", "32x32", "--measure", "--samples", "3"})
            .out,
        Catch::Contains("nothing is skipped"));
    CHECK(json_of({"explain", scene, "--json"})["clock"] == "none: explain measures only with --measure");

    check_refused(run_program({"explain", scene, "--measure", "--no-skip"}), "give one of them");
    check_refused(run_program({"explain", scene, "--measure", "--shader", "x"}), "--shader");
    check_refused(run_program({"explain", scene, "--measure", "--samples", "1"}), "--samples");
}

TEST_CASE("bench --no-skip measures both ways") {
    const TemporaryDirectory scratch;
    const Json json = json_of({"bench", empty_scene(scratch), "--chain", "default", "--no-skip",
                               "--with-scene", "--size", "96x64", "--samples", "3", "--json"});
    std::map<std::string, std::int64_t> bytes;
    for (const Json& row : json["rows"])
        bytes[row["name"]] = row["texture_bytes"].is_null() ? 0 : row["texture_bytes"].get<std::int64_t>();
    REQUIRE(bytes.count("default") == 1);
    REQUIRE(bytes.count("default (no skip)") == 1);
    CHECK(bytes["default"] < bytes["default (no skip)"]);
    CHECK(bytes["scene alone"] == 96 * 64 * (8 + 4));
}

TEST_CASE("skips tells every effect of every scene") {
    const TemporaryDirectory scratch;
    const std::string scene = empty_scene(scratch);
    const std::vector<std::string> ids = effect_ids();
    const Json json = json_of({"skips", scene, "sky", "--size", "48x32", "--samples", "3", "--json"});
    REQUIRE(json["scenes"].size() == 2);
    for (const Json& found : json["scenes"]) {
        CHECK(found["empty"] == Json({"depth", "normal", "emission", "ambient"}));
        std::vector<std::string> names;
        for (const Json& row : found["rows"]) {
            names.push_back(row["name"]);
            for (const Json& effect : row["effects"]) {
                INFO(effect.dump());
                if (effect["status"] != "skipped") continue;
                CHECK(std::set<std::string>{"configuration", "scene", "frame"}.count(effect["moment"]) == 1);
                CHECK(std::set<std::string>{"exact", "code", "visible", "lacks"}.count(effect["kind"]) == 1);
                CHECK_FALSE(effect["reason"].get<std::string>().empty());
            }
        }
        REQUIRE(names.size() == ids.size() + 2); // before them no effect, after them the chain
        CHECK(std::equal(ids.begin(), ids.end(), names.begin() + 1));
    }

    const std::string page = scratch / "page.md";
    const Outcome written =
        run_program({"skips", scene, "--size", "48x32", "--samples", "3", "--chain", "none", "-o", page});
    CHECK(written.status == 0);
    CHECK(written.out == "wrote " + page + "\n");
    const std::string text = file_bytes(page);
    CHECK_THAT(text, Catch::StartsWith("<!-- Made by `postfx skips "));
    CHECK_THAT(text, Catch::Contains("\n## nothing\n"));
    for (const std::string& id : ids)
        CHECK_THAT(text, Catch::Contains("\n| " + id + " | "));

    check_refused(run_program({"skips", "skie"}), "did you mean \"sky\"?");
    check_refused(run_program({"skips", "sky", "--size", "0x4"}), "0x4");
    check_refused(run_program({"skips", "sky", "--chain", "defalt"}), "did you mean \"default\"?");
    check_refused(run_program({"skips", scene, "--size", "8x8", "--samples", "3", "-o",
                               (scratch / "missing/page.md").string()}),
                  "missing/page.md");
}

TEST_CASE("former words are understood with a note") {
    const TemporaryDirectory scratch;
    const std::string scene = empty_scene(scratch);
    const Outcome all = run_program({"explain", scene, "--chain", "default", "--json", "--run-all"});
    CHECK(all.status == 0);
    CHECK_THAT(all.err, Catch::Contains("--run-all is called --no-skip now"));
    CHECK(skipped_in(Json::parse(all.out)) == 0);
    const Outcome help = run_program({"called-for", "--help"});
    CHECK(help.status == 0);
    CHECK_THAT(help.err, Catch::Contains("called-for is called skips now"));
    CHECK_THAT(help.out, Catch::Contains("postfx skips"));
    CHECK_THAT(run_program({"explain", "--help"}).out, !Catch::Contains("--run-all"));
}

TEST_CASE("docs/called-for.md tells every scene and every effect that there is") {
    const std::string page = file_bytes(POSTFX_SOURCE_DIRECTORY "/docs/called-for.md");
    INFO("make it again with the command that stands in it");
    for (const Json& scene : json_of({"list", "scenes", "--json"}))
        CHECK_THAT(page, Catch::Contains("\n## " + scene["id"].get<std::string>() + "\n"));
    for (const std::string& id : effect_ids())
        CHECK_THAT(page, Catch::Contains("\n| " + id + " | "));
}
