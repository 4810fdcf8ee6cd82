// postfx study from outside: the folder that it leaves, what it refuses, and its page in a browser.
#include "program.hpp"

#include <image/files.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <iostream>
#include <set>
#include <string>

using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

/// As small and short as a study can be.
std::vector<std::string> study(const TemporaryDirectory& folder, const std::vector<std::string>& more,
                               const std::string& samples = "4") {
    std::vector<std::string> arguments = {
        "study", "--size",        "48x27",   "--time-size", "64x36",   "--small-time-size",
        "32x18", "--rounds",      "2",       "--seconds",   "1",       "--samples",
        samples, "--scene",       "cornell", "--no-growth", "--store", folder / "store",
        "-o",    folder / "study"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

bool there_is_a_browser() {
    return run_command({"chromium", "--version"}).status == 0;
}

struct Visit {
    Outcome outcome;
    postfx::Image screenshot;
};

Visit visit(const std::filesystem::path& page, const TemporaryDirectory& folder, int width) {
    const std::filesystem::path picture = folder / ("page" + std::to_string(width) + ".png");
    Visit visit;
    visit.outcome = run_command(
        {"timeout", "120", "chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
         "--user-data-dir=" + (folder / "browser").string(), "--host-resolver-rules=MAP * ~NOTFOUND",
         "--enable-logging=stderr", "--window-size=" + std::to_string(width) + ",1600",
         "--screenshot=" + picture.string(), "file://" + page.string()});
    if (std::filesystem::exists(picture)) visit.screenshot = postfx::read_image(picture).image;
    return visit;
}

/// Share of the pixels that are not of the most frequent colour of their row.
double inked(const postfx::Image& image) {
    std::size_t count = 0;
    for (int y = 0; y < image.height; ++y) {
        std::map<std::array<float, 3>, std::size_t> colors;
        for (int x = 0; x < image.width; ++x)
            ++colors[{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)}];
        std::size_t most = 0;
        for (const auto& [color, pixels] : colors)
            most = std::max(most, pixels);
        count += static_cast<std::size_t>(image.width) - most;
    }
    return static_cast<double>(count) / static_cast<double>(image.pixel_count());
}

} // namespace

TEST_CASE("a study leaves tables, curves, plots, pictures and a page") {
    const TemporaryDirectory folder;
    const Outcome outcome = run_program(study(folder, {"vignette", "tonemap", "--json"}));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Json json = Json::parse(outcome.out);
    CHECK(json == Json::parse(file_bytes(folder / "study/study.json")));
    CHECK_FALSE(json["device"].get<std::string>().empty());
    CHECK_FALSE(json["clock"].get<std::string>().empty());
    CHECK_THAT(json["program"].get<std::string>(), Catch::Contains("commit "));
    CHECK_THAT(json["command"].get<std::string>(), Catch::StartsWith("postfx study vignette tonemap"));
    REQUIRE(json["effects"].size() == 2);
    const Json& vignette = json["effects"][0];
    CHECK(vignette["id"] == "vignette");
    REQUIRE(vignette["scenes"].size() == 1);
    CHECK(vignette["scenes"][0]["name"] == "cornell");
    for (const Json& level : vignette["levels"]) {
        CHECK(level["scenes"][0]["costs"].size() == 2);
        CHECK(level["scenes"][0]["costs"][0]["ms"]["rounds"] == 2);
    }
    CHECK(json["effects"][1]["levels"].size() == 1); // tonemap has no levels

    for (const char* name : {"study.csv", "metrics.csv", "growth.csv", "curves.json", "index.html",
                             "pictures/vignette-given.png", "pictures/tonemap-given.png"})
        CHECK_FALSE(file_bytes(folder / (std::string("study/") + name)).empty());

    if (!there_is_a_browser()) {
        std::cout << "no chromium here: the page was not opened\n";
        return;
    }
    for (const int width : {1280, 500}) {
        const Visit seen = visit(folder / "study/index.html", folder, width);
        INFO(seen.outcome.err);
        CHECK(seen.outcome.status == 0);
        // Errors of the page, and requests that its policy forbids, are told on the console.
        CHECK(seen.outcome.err.find("CONSOLE") == std::string::npos);
        REQUIRE(seen.screenshot.width == width);
        CHECK(inked(seen.screenshot) > 0.02); // text alone covers more
        CHECK(inked(seen.screenshot) < 0.9);
    }
}

TEST_CASE("an effect that no truth and no entry of the study knows gets times only") {
    const TemporaryDirectory folder;
    const Outcome outcome = run_program(study(folder, {"tint", "--plugin-dir", POSTFX_FIXTURES}));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Catch::Contains("tint: its only level takes"));
    CHECK_THAT(outcome.out, Catch::Contains("no truth of it is known"));
    const Json json = Json::parse(file_bytes(folder / "study/study.json"));
    CHECK(json["effects"][0]["levels"][0]["error"].is_null());
    CHECK(Json::parse(file_bytes(folder / "study/curves.json"))["effects"].empty());
}

TEST_CASE("an effect of your own is studied as the entry beside its module says, at its place told what is "
          "wrong with it") {
    const TemporaryDirectory folder;
    const std::filesystem::path plugins = folder / "plugins";
    std::filesystem::create_directory(plugins);
    std::filesystem::copy_file(POSTFX_FIXTURES "/postfx_fixture_tint.so", plugins / "postfx_tint.so");
    std::ofstream(plugins / "postfx_tint.study.yaml") << "values: {amount: 0.25, mode: add}\n";
    const Outcome outcome = run_program(study(folder, {"tint", "--plugin-dir", plugins}));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Json json = Json::parse(file_bytes(folder / "study/study.json"));
    CHECK(json["effects"][0]["values"] == "amount: 0.25, mode: add");

    std::ofstream(plugins / "postfx_tint.study.yaml") << "value: {amount: 0.25}\n";
    const Outcome refused = run_program(study(folder, {"tint", "--plugin-dir", plugins}));
    CHECK(refused.status == 2);
    CHECK_THAT(refused.err, Catch::Contains("postfx_tint.study.yaml:1:") && Catch::Contains("values"));
}

TEST_CASE("taps are what the effect's shaders read; where they can't count, a note says so") {
    const TemporaryDirectory folder;
    const Outcome outcome =
        run_program(study(folder, {"tint", "blur", "sneaky_redefine", "--plugin-dir", POSTFX_FIXTURES}));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const Json effects = Json::parse(file_bytes(folder / "study/study.json"))["effects"];
    CHECK(effects[0]["levels"][0]["taps_per_pixel"] == 0.0); // in one pass with the encoding
    // Two passes of five, at half the size and at full size, and one read of what came out.
    CHECK(effects[1]["levels"][0]["taps_per_pixel"] == 2 * 5 * 0.25 + 1);
    CHECK(effects[1]["levels"][1]["taps_per_pixel"] == 2 * 5 + 1.0);
    CHECK(effects[2]["levels"][0]["taps_per_pixel"].is_null());
    CHECK_THAT(effects[2]["notes"].dump(), Catch::Contains("taps are not known: "));
    CHECK_THAT(outcome.out, Catch::Contains("(taps are not known: "));
}

TEST_CASE("an effect that fails takes no other with it") {
    const TemporaryDirectory folder;
    const Outcome outcome =
        run_program(study(folder, {"tint", "broken_shader", "gauge", "--plugin-dir", POSTFX_FIXTURES}));
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Catch::Contains("broken_shader could not be studied"));
    const Json json = Json::parse(file_bytes(folder / "study/study.json"));
    CHECK(json["effects"].size() == 2);
    REQUIRE(json["failures"].size() == 1);
    CHECK(json["failures"][0]["effect"] == "broken_shader");
    CHECK_THAT(file_bytes(folder / "study/index.html"), Catch::Contains("was not studied to the end"));
}

TEST_CASE("a study that is stopped keeps what it has finished") {
    const TemporaryDirectory folder;
    std::string command = POSTFX_BUILD_DIRECTORY "/postfx";
    // So many samples that the second effect's truth would take hours.
    for (const std::string& word :
         study(folder, {"tint", "ssao", "--plugin-dir", POSTFX_FIXTURES}, "1048576"))
        command += " '" + word + "'";
    const std::string page = folder / "study/index.html";
    const Outcome outcome =
        run_command({"bash", "-c",
                     command + " & while ! [ -e '" + page
                         + "' ]; do sleep 0.1; kill -0 $! || exit 99; done; kill -INT $!; wait $!"});
    INFO(outcome.err);
    CHECK(outcome.status == 130);
    CHECK_THAT(outcome.err, Catch::Contains("stopped; 1 of 2 effects are written"));
    const Json json = Json::parse(file_bytes(folder / "study/study.json"));
    CHECK(json["effects"][0]["id"] == "tint");
    CHECK(json["failures"][0]["effect"] == "ssao");
}

TEST_CASE("what a study is asked for wrongly is refused") {
    const TemporaryDirectory folder;
    check_refused(run_program(study(folder, {"vignete"})), "vignette");
    check_refused(run_program({"study", "vignette", "--samples", "7"}), "even");
    check_refused(run_program({"study", "vignette", "--size", "big"}), "WIDTHxHEIGHT");
    check_refused(run_program({"study", "vignette", "--spec", folder / "none.yaml"}), "none.yaml");
}
