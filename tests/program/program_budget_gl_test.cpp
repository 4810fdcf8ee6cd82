// Budgets from outside: what explain tells of the choice, what is refused, and calibrate into a cache of its own.
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

/// Made up for this test: at 0.2304 megapixels bloom takes 2, 4 or 10 ms, ssao 5, 10 or 25, encoding 1.
constexpr const char* curves_text = R"({
  "device": "made up", "driver": "1", "clock": "none", "made_by": "a test",
  "base": {"fixed_ms": 1, "ms_per_megapixel": 0},
  "effects": {
    "bloom": [
      {"level": "low", "fixed_ms": 2, "ms_per_megapixel": 0, "error": 0.05, "step_to_next": 0.004},
      {"level": "medium", "fixed_ms": 4, "ms_per_megapixel": 0, "error": 0.02, "step_to_next": 0.002},
      {"level": "high", "fixed_ms": 10, "ms_per_megapixel": 0, "error": 0.005, "step_to_next": 0}],
    "ssao": [
      {"level": "low", "fixed_ms": 5, "ms_per_megapixel": 0, "error": 0.08, "step_to_next": 0.008},
      {"level": "medium", "fixed_ms": 10, "ms_per_megapixel": 0, "error": 0.04, "step_to_next": 0.006},
      {"level": "high", "fixed_ms": 25, "ms_per_megapixel": 0, "error": 0.02, "step_to_next": 0}]
  }
})";

struct Folder {
    TemporaryDirectory directory;
    std::string curves = directory / "made_up.json";
    std::string chain = directory / "chain.yaml";

    Folder() {
        put_bytes(curves, curves_text);
        put_bytes(chain, "budget: {ms: 16}\neffects: [ssao, bloom, vignette]\n");
    }
    /// With a cache that begins empty.
    Outcome run(std::vector<std::string> arguments) const {
        std::vector<std::string> command = {"env", "XDG_CACHE_HOME=" + (directory / "cache").string(),
                                            POSTFX_BUILD_DIRECTORY "/postfx"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return run_command(command);
    }
    /// By the curves alone: what is expected can be reckoned from them.
    Json explain(std::vector<std::string> more) const {
        more.emplace_back("--by-curves");
        return explain_tried(more);
    }
    Json explain_tried(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments = {"explain", "cornell", "--chain", chain,   "--curves",
                                              curves,    "--size",  "640x360", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        INFO(outcome.err);
        REQUIRE(outcome.status == 0);
        return Json::parse(outcome.out).at("budget");
    }
};

std::string level_of(const Json& budget, const std::string& name) {
    for (const Json& effect : budget["effects"]) {
        if (effect["name"] == name) return effect["level"];
    }
    return "none";
}

} // namespace

TEST_CASE("explain tells which levels a budget buys") {
    const Folder folder;
    const Json budget = folder.explain({});
    CHECK(budget["budget"]["ms"] == 16);
    CHECK(budget["fits"] == true);
    CHECK(budget["predicted_ms"] == 15);
    CHECK(level_of(budget, "ssao") == "medium");
    CHECK(level_of(budget, "bloom") == "medium");
    CHECK(budget["effects"][2]["role"] == "unknown");
    CHECK(budget["effects"][2]["ms"].is_null());
    CHECK(budget["runner_up"]["lost_by"]
          == "ms"); // bloom high: 31 % too slow; bloom low: an error 43 % larger
    CHECK(budget["curves"]["device"] == "made up");

    const Json tight = folder.explain({"--budget", "ms=5"});
    CHECK(tight["fits"] == false);
    CHECK(level_of(tight, "ssao") == "low");
    CHECK(level_of(tight, "bloom") == "low");
    const Json exact = folder.explain({"--budget", "error=0.021"});
    CHECK(exact["budget"]["error"] == 0.021);
    CHECK(level_of(exact, "ssao") == "high");
    CHECK(level_of(exact, "bloom") == "high");
}

TEST_CASE("explain tells pins and what costs nothing") {
    const Folder folder;
    put_bytes(folder.chain, "effects: [ssao: {pin: low}, bloom: {enabled: false}]\n");
    const Json budget = folder.explain({"--budget", "ms=100"});
    CHECK(level_of(budget, "ssao") == "low");
    CHECK(budget["effects"][0]["role"] == "pinned");
    CHECK(budget["effects"][1]["role"] == "skipped");
    CHECK(budget["effects"][1]["ms"] == 0);
    CHECK(budget["predicted_ms"] == 6);

    const Outcome spoken = folder.run(
        {"explain", "cornell", "--chain", folder.chain, "--curves", folder.curves, "--budget", "ms=100"});
    CHECK(spoken.status == 0);
    CHECK_THAT(spoken.out, Catch::Contains("budget: 100 ms\n") && Catch::Contains("pinned")
                               && Catch::Contains("skipped, configuration: enabled is false")
                               && Catch::Contains("predicted 6 ms, 1 of them without any effect")
                               && Catch::Contains(folder.curves));
}

TEST_CASE("levels are chosen by what they do in the scene") {
    const Folder folder;
    // By the curves bloom is farther from its truth than ssao at any level, and the scene has nothing that glows.
    put_bytes(folder.chain, "effects: [ssao: {radius: 1}, bloom: {intensity: 0.0001}]\n");
    put_bytes(folder.curves, R"({
        "device": "made up", "driver": "1", "clock": "none", "made_by": "a test",
        "base": {"fixed_ms": 0, "ms_per_megapixel": 0},
        "effects": {
          "bloom": [{"level": "low", "fixed_ms": 1, "ms_per_megapixel": 0, "error": 0.5, "step_to_next": 0},
                    {"level": "high", "fixed_ms": 5, "ms_per_megapixel": 0, "error": 0.3, "step_to_next": 0}],
          "ssao": [{"level": "low", "fixed_ms": 1, "ms_per_megapixel": 0, "error": 0.05, "step_to_next": 0},
                   {"level": "high", "fixed_ms": 5, "ms_per_megapixel": 0, "error": 0.02, "step_to_next": 0}]
        }})");
    const Json by_curves = folder.explain({"--budget", "ms=6"});
    CHECK(level_of(by_curves, "bloom") == "high");
    CHECK(level_of(by_curves, "ssao") == "low");
    CHECK(by_curves["tried"].empty());
    const Json tried = folder.explain_tried({"--budget", "ms=6"});
    CHECK(level_of(tried, "bloom") == "low");
    CHECK(level_of(tried, "ssao") == "high");
    CHECK(tried["tried"] == Json::array({"bloom", "ssao"}));
    CHECK(tried["predicted_error"].get<double>() < by_curves["predicted_error"].get<double>());
    CHECK(tried == folder.explain_tried({"--budget", "ms=6"})); // what is drawn is the same every time

    // Where there is time for one level alone, there is nothing to try.
    CHECK(folder.explain_tried({"--budget", "ms=2"})["tried"].empty());

    const Outcome spoken = folder.run({"explain", "cornell", "--size", "64x36", "--chain", folder.chain,
                                       "--curves", folder.curves, "--budget", "error=0.1"});
    CHECK(spoken.status == 0);
    CHECK_THAT(spoken.out, Catch::Contains("errors: tried in this scene: bloom, ssao\n"));
}

TEST_CASE("a budget that can't be met by anything known is refused") {
    const Folder folder;
    const auto explain = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"explain", "cornell", "--chain", folder.chain};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return folder.run(arguments);
    };
    check_refused(explain({"--budget", "ms=soon"}), "--budget:1:5: budget.ms: expected a number above 0");
    check_refused(explain({"--budget", "6"}), "expected ms=MILLISECONDS or error=SHARE");
    check_refused(explain({"--curves", folder.directory / "none.json"}), "none.json");
    put_bytes(folder.curves, "{}");
    check_refused(explain({"--curves", folder.curves}), "made_up.json: curves: \"device\" is missing");
    put_bytes(folder.chain, "budget: {ms: 6, error: 1}\neffects: [bloom]\n");
    check_refused(explain({}), "chain.yaml:1:17: \"budget\" has two keys");
}

TEST_CASE("render draws the levels that the budget buys") {
    const Folder folder;
    const std::string picture = folder.directory / "a.png";
    const Outcome outcome =
        folder.run({"render", "cornell", "--size", "64x36", "--chain", folder.chain, "--curves",
                    folder.curves, "--budget", "ms=100", "-o", picture, "--json", "--no-times"});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK(level_of(Json::parse(outcome.out)["budget"], "ssao") == "high");
    put_bytes(folder.chain, "effects: [ssao: {quality: high}, bloom: {quality: high}, vignette]\n");
    const std::string by_hand = folder.directory / "b.png";
    REQUIRE(folder.run({"render", "cornell", "--size", "64x36", "--chain", folder.chain, "-o", by_hand, "-q"})
                .status
            == 0);
    CHECK(file_bytes(picture) == file_bytes(by_hand));
}

TEST_CASE("calibrate measures times, and budgets are met by them from then on") {
    const Folder folder;
    const Outcome outcome = folder.run({"calibrate", "--quick", "--curves", folder.curves, "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Json measured = Json::parse(outcome.out);
    CHECK(measured["device"] != "made up");
    CHECK_THAT(measured["made_by"].get<std::string>(),
               Catch::StartsWith("postfx calibrate --quick, postfx ") && Catch::EndsWith("errors: a test"));
    REQUIRE(measured["effects"].size() == 2);
    const Json& ssao = measured["effects"]["ssao"];
    REQUIRE(ssao.size() == 3);
    const auto ms = [](const Json& level) {
        return level["fixed_ms"].get<double>() + level["ms_per_megapixel"].get<double>();
    };
    CHECK(ms(ssao[0]) > 0);
    CHECK(ms(ssao[2]) > ms(ssao[0])); // several times: noise does not turn that round
    CHECK(ms(ssao[2]) != 25);
    CHECK(ssao[2]["error"] == 0.02);
    CHECK(ssao[0]["step_to_next"] == 0.008);

    const Outcome explained = folder.run({"explain", "cornell", "--chain", folder.chain, "--json"});
    REQUIRE(explained.status == 0);
    const Json curves = Json::parse(explained.out)["budget"]["curves"];
    CHECK(curves["device"] == measured["device"]);
    CHECK(curves["note"] == "");
    CHECK_THAT(curves["file"].get<std::string>(), Catch::Contains("cache/postfx/curves/"));
}

TEST_CASE("budgets compares chosen levels with one level for all") {
    const Folder folder;
    put_bytes(folder.chain, "effects: [ssao, bloom, vignette, tonemap, grain]\n");
    const Outcome outcome = folder.run({"budgets", "cornell", "--chain", folder.chain, "--curves",
                                        folder.curves, "--size", "48x27", "--levels", "low", "--levels",
                                        "high", "--budgets", "3", "--samples", "3", "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Json proof = Json::parse(outcome.out)["proofs"][0];
    CHECK(proof["scene"] == "cornell");
    CHECK(proof["truths"].size() == 3); // what comes from the tone map on is left out
    const Json& settings = proof["settings"];
    REQUIRE(settings.size() >= 2);
    CHECK(settings[0]["name"] == "all low");
    CHECK(settings[1]["name"] == "all high");
    for (const Json& setting : settings) {
        CHECK(setting["ms"] > 0);
        CHECK(setting["error"] > 0);
        CHECK(setting["error"] < 1); // of black it would be 1
    }
    REQUIRE(proof["budgets"].size() == 3);
    // The first budget is what the quicker of both took, the last the slower one.
    const double first = proof["budgets"][0]["ms"], last = proof["budgets"][2]["ms"];
    CHECK(first < last);
    CHECK(proof["budgets"][1]["ms"].get<double>() == Approx(std::sqrt(first * last)));

    check_refused(folder.run({"budgets", "cornell", "--chain", folder.chain, "--curves", folder.curves,
                              "--levels", "fine"}),
                  "no effect of the chain has a level \"fine\"");
}

TEST_CASE("the curves that come along answer a budget for every effect of the default chain") {
    const Folder folder;
    const Outcome outcome =
        folder.run({"explain", "still_life", "--chain", "default", "--budget", "error=10", "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Json budget = Json::parse(outcome.out)["budget"];
    CHECK(budget["fits"] == true);
    for (const Json& effect : budget["effects"]) {
        INFO(effect.dump());
        CHECK(effect["role"] != "unknown");
    }
}
