// What is told of findings: sentences, tables, plots, the page.
#include "study_findings.hpp"

#include <catch2/catch.hpp>

#include <study/effect_plots.hpp>
#include <study/labels.hpp>
#include <study/log_scale.hpp>
#include <study/output.hpp>
#include <study/page.hpp>
#include <study/pareto.hpp>
#include <study/plot.hpp>
#include <study/sentences.hpp>
#include <study/tables.hpp>
#include <temporary_directory.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

using namespace postfx::host::study;
using namespace postfx::testing;

namespace {

EffectFindings ladder() {
    EffectFindings effect = made_effect({made_level("medium", 10, 0.08), made_level("high", 16, 0.02),
                                         made_level("ultra", 40, 0.05), made_level("classic", 12, 0.4)});
    effect.thumbnails.push_back({"given", 2, 1, {0, 0, 0, 255, 255, 255}});
    effect.growth.push_back({.over = "radius",
                             .scene = "attic",
                             .truth = "scene",
                             .conditions = "radius by reach",
                             .curves = {{"high", {{2, 1, 0.1}, {4, 2, 0.2}}, 1.0, 1.0}},
                             .left_out = {"ultra"}});
    conclude(effect);
    return effect;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

bool says(const std::vector<std::string>& sentences, const std::string& sentence) {
    return std::find(sentences.begin(), sentences.end(), sentence) != sentences.end();
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

} // namespace

TEST_CASE("sentences say what the numbers are") {
    const std::vector<std::string> sentences = sentences_of(ladder());
    for (const std::string& sentence : sentences)
        UNSCOPED_INFO(sentence);
    CHECK(sentences[0]
          == "haze: medium is 8.0 % away from the truth and takes 10 ms; high is 4.0x closer to the truth "
             "than medium "
             "for 1.6x the time.");
    CHECK(says(sentences,
               "The way it is usually done (classic) is 5.0x farther from the truth than medium for 1.2x "
               "the time."));
    CHECK(says(sentences,
               "ultra is not worth its time: high is 2.5x closer to the truth than ultra and 2.5x faster."));
    CHECK(says(sentences, "At best, high is 2.0 % away from the truth; the truth itself is known to 0.1 %."));
    CHECK(says(sentences, "Time grows with the radius to the power of: high 1.00."));
}

TEST_CASE("sentences of the best that inputs allow, of exact levels, and of none that is known") {
    EffectFindings effect = ladder();
    for (SceneFindings& scene : effect.scenes)
        scene.inputs_error = 0.015;
    CHECK(says(sentences_of(effect), "At best, high is 2.0 % away from the truth; the best that can be made "
                                     "of what the effect is given is "
                                     "itself 1.5 % away; the truth itself is known to 0.1 %."));

    EffectFindings exact = made_effect({made_level("low", 1, 0.1), made_level("high", 2, 0)}, 0);
    conclude(exact);
    CHECK(sentences_of(exact)[0]
          == "haze: low is 10 % away from the truth and takes 1.0 ms; high is exact where low is not for "
             "2.0x the "
             "time.");

    EffectFindings unknown = made_effect({made_level("", 3, 0)});
    unknown.judged_by = "";
    conclude(unknown);
    CHECK(sentences_of(unknown)[0]
          == "haze: its only level takes 3.0 ms. How close it is to the truth is not known.");
}

TEST_CASE("numbers are as long as they mean something") {
    CHECK(times_text(1.649) == "1.6x");
    CHECK(times_text(350.4) == "350x");
    CHECK(times_text(0.123) == "0.12x");
    CHECK(percent_text(0.0035) == "0.35 %");
    CHECK(percent_text(0) == "0 %");
    CHECK(duration_text(1234) == "1.2 s");
    CHECK(duration_text(0.5) == "0.5 ms");
    CHECK(duration_text(-0.1) == "no time that can be measured");
    CHECK(tick_text(1500) == "1,500");
    CHECK(tick_text(0.002) == "0.002");
}

TEST_CASE("every effect, scene and level has a line of CSV with all its columns") {
    EffectFindings effect = ladder();
    effect.levels[0].scenes[0].skipped = "nothing, \"really\"";
    effect.levels[1].scenes[1].errors["scene"].flip = std::numeric_limits<double>::infinity();
    const std::vector<std::string> lines = lines_of(findings_csv(made_findings(effect)));
    REQUIRE(lines.size() == 1 + 2 * 4);
    const auto columns = std::count(lines[0].begin(), lines[0].end(), ',');
    for (std::size_t i = 2; i < lines.size(); ++i)
        CHECK(std::count(lines[i].begin(), lines[i].end(), ',') == columns);
    CHECK_THAT(lines[0],
               Catch::StartsWith("effect,scene,level,relative_rmse_scene,own_error_scene,flip_scene,"));
    CHECK_THAT(lines[1], Catch::StartsWith("haze,attic,medium,0.08,0.001,0.04,,,,10,9.9,10.1,5,11,2.5,"));
    CHECK_THAT(lines[1], Catch::EndsWith(",\"nothing, \"\"really\"\"\""));
    CHECK_THAT(lines[6], Catch::StartsWith("haze,cellar,high,0.02,0.001,,,,,16,"));
    CHECK_THAT(lines[3], Catch::Contains(",high,"));
    CHECK_THAT(lines[0],
               Catch::Contains(",passes,bytes_written_per_pixel,bytes_read_per_pixel,taps_per_pixel,error,"));
    CHECK_THAT(lines[2], Catch::Contains(",1,8,0,4,0.02,"));
    CHECK_THAT(lines[6], Catch::Contains(",1,8,0,6.5,0.02,"));

    const std::vector<std::string> growth = lines_of(growth_csv(made_findings(effect)));
    REQUIRE(growth.size() == 3);
    CHECK(growth[2] == "haze,radius,attic,high,4,2,0.2,1,1");
}

TEST_CASE("JSON holds conditions, levels, verdicts and what failed; what is not finite is null") {
    EffectFindings effect = ladder();
    effect.metrics = {{"edge", "px", "where an edge is", false}};
    for (Level& level : effect.levels)
        level.metrics = {std::nan("")};
    Findings findings = made_findings(effect);
    findings.failures.push_back({"mist", "no such lamp"});
    const auto json = findings_json(findings);
    CHECK(json["device"] == "paper");
    CHECK(json["program"] == "postfx 1.2 (commit abc)");
    CHECK(json["failures"][0]["effect"] == "mist");
    const auto& haze = json["effects"][0];
    CHECK(haze["curve"] == nlohmann::ordered_json({"medium", "high"}));
    CHECK(haze["levels"][2]["dominated_by"] == "high");
    CHECK(haze["levels"][0]["metrics"]["edge"].is_null());
    CHECK(haze["levels"][0]["scenes"][1]["scene"] == "cellar");
    CHECK(haze["levels"][0]["scenes"][1]["costs"][0]["ms"]["rounds"] == 11);
    CHECK(haze["levels"][0]["scenes"][1]["errors"]["scene"]["flip"] == 0.04);
    CHECK(haze["scenes"][0]["truths"][0]["own_error"] == 0.001);
    CHECK(haze["growth"][0]["curves"][0]["time_exponent"] == 1.0);
    CHECK(haze["levels"][0]["taps_per_pixel"] == 5.25);
    CHECK(haze["levels"][0]["scenes"][1]["taps_per_pixel"] == 6.5);
}

TEST_CASE("logarithmic axes hold all values and name some of them") {
    const LogScale scale({0.5, 30, 0, -1, std::numeric_limits<double>::infinity()}, 100, 0);
    CHECK(scale.low() < 0.5);
    CHECK(scale.high() > 30);
    CHECK(scale.at(scale.low()) == Approx(100));
    CHECK(scale.at(scale.high()) == Approx(0).margin(1e-9)); // rounding of a logarithm, in pixels
    CHECK(scale.at(std::sqrt(scale.low() * scale.high())) == Approx(50));
    CHECK(scale.at(1e-9) == Approx(100));
    for (const std::vector<double>& values :
         {std::vector<double>{}, {5}, {1, 1.01}, {1e-9, 1e9}, {0.99, 1000}}) {
        const LogScale axis(values, 0, 1);
        int labelled = 0;
        for (const LogScale::Tick& tick : axis.ticks()) {
            CHECK(axis.at(tick.value) >= 0);
            CHECK(axis.at(tick.value) <= 1);
            labelled += tick.labelled ? 1 : 0;
        }
        CHECK(labelled >= 1);
        CHECK(labelled <= 9);
    }
}

TEST_CASE("labels of marks that lie close together do not hide each other") {
    LabelPlacer placer({0, 0, 400, 300});
    std::vector<Box> boxes;
    for (const double x : {100.0, 112.0, 124.0}) {
        placer.avoid({x - 6, 94, x + 6, 106});
        boxes.push_back({x - 6, 94, x + 6, 106});
    }
    for (const double x : {100.0, 112.0, 124.0}) {
        const LabelPlacer::Place place = placer.place(x, 100, "medium", 12);
        const double shift = place.anchor == std::string("end")      ? -text_width("medium", 12)
                             : place.anchor == std::string("middle") ? -text_width("medium", 12) / 2
                                                                     : 0;
        const Box box = text_box(place.x + shift, place.y, "medium", 12);
        for (const Box& other : boxes)
            CHECK(box.overlap(other) == 0);
        boxes.push_back(box);
    }
    std::vector<EndLabel> ends = {{50, "a"}, {51, "b"}, {52, "c"}, {290, "d"}};
    spread_out(ends, 10, 280, 15);
    for (std::size_t i = 1; i < ends.size(); ++i)
        CHECK(ends[i].y - ends[i - 1].y >= 15 - 1e-9); // rounding
    CHECK(ends.back().y <= 280);
}

TEST_CASE("plots show every level, dominated ones hollow, and the hull") {
    const std::vector<EffectPlot> plots = error_plots(ladder());
    REQUIRE(plots.size() == 2); // from the truth, and FLIP
    const std::string& svg = plots[0].svg;
    for (const char* level : {">medium<", ">high<", ">ultra<", ">classic<"})
        CHECK(count_of(svg, level) == 1);
    CHECK(count_of(svg, "class=\"mark level full\"") == 2);
    CHECK(count_of(svg, "class=\"mark level hollow\"") == 1);
    CHECK(count_of(svg, "class=\"mark classic hollow\"") == 1);
    CHECK(count_of(svg, "class=\"hull\"") == 1);
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
    CHECK(standalone_svg(svg).find("<style>") != std::string::npos);
    CHECK(growth_plots(ladder()).size() == 2);
}

TEST_CASE("floors lie where they are, also below all levels") {
    ScatterPlot plot;
    plot.marks = {{.label = "low", .x = 1, .y = 1, .x_low = 1, .x_high = 1}};
    plot.y_floor = 0.3;
    plot.floors = {{0.2, "one"}, {0.1, "two"}};
    const std::string svg = scatter_svg(plot);
    std::vector<double> heights;
    for (std::size_t at = svg.find("class=\"floor\""); at != std::string::npos;
         at = svg.find("class=\"floor\"", at + 1))
        heights.push_back(std::stod(svg.substr(svg.find("y1=\"", at) + 4)));
    REQUIRE(heights.size() == 2);
    const double mark = std::stod(svg.substr(svg.find("cy=\"") + 4));
    CHECK(mark < heights[0]);
    CHECK(heights[0] < heights[1]);
}

TEST_CASE("levels without a time or an error that can be measured are drawn all the same") {
    EffectFindings effect = made_effect({made_level("low", -0.001, 0.1), made_level("high", 2, 0)}, 0);
    conclude(effect);
    const std::string svg = error_plots(effect).front().svg;
    CHECK(count_of(svg, "class=\"mark") == 2);
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
}

TEST_CASE("base64 is that of RFC 4648") {
    for (const auto& [bytes, text] : {std::pair("", ""),
                                      {"f", "Zg=="},
                                      {"fo", "Zm8="},
                                      {"foo", "Zm9v"},
                                      {"foob", "Zm9vYg=="},
                                      {"fooba", "Zm9vYmE="},
                                      {"foobar", "Zm9vYmFy"}})
        CHECK(base64(bytes) == text);
    CHECK(base64("\xff\xfe") == "//4=");
}

TEST_CASE("the page needs nothing else and escapes what it is told") {
    const std::string page = study_page(made_findings(ladder()), {{"haze-given", "PNG"}});
    CHECK_THAT(page, Catch::StartsWith("<!DOCTYPE html>"));
    CHECK(page.find("Makes &lt;things&gt; hazy") != std::string::npos);
    CHECK(page.find("<things>") == std::string::npos);
    CHECK(page.find("<script") == std::string::npos);
    CHECK(page.find("url(") == std::string::npos);
    CHECK(page.find("@import") == std::string::npos);
    // What looks like an address is only the name of SVG.
    CHECK(count_of(page, "http")
          == count_of(page, "http://www.w3.org/2000/svg") + count_of(page, "http-equiv"));
    CHECK(page.find("src=\"data:image/png;base64,UE5H\"") != std::string::npos);
    CHECK(page.find("high is 4.0x closer to the truth than medium for 1.6x the time") != std::string::npos);
    CHECK(count_of(page, "<td>5.25</td>") == 4); // taps of each level
    CHECK(count_of(page, "<section") == count_of(page, "</section>"));
    CHECK(count_of(page, "<table") == count_of(page, "</table>"));
}

TEST_CASE("a study is a folder of files that are what they say") {
    const TemporaryDirectory folder;
    const std::vector<std::string> names = write_study(folder / "study", made_findings(ladder()));
    for (const std::string& name : names)
        CHECK_FALSE(file_bytes(folder / ("study/" + name)).empty());
    CHECK(file_bytes(folder / "study/pictures/haze-given.png").starts_with("\x89PNG"));
    CHECK_THAT(file_bytes(folder / "study/haze-error.svg"), Catch::StartsWith("<svg"));
    const postfx::Curves curves = postfx::read_curves(folder / "study/curves.json");
    CHECK(curves.find("haze", "high")->error == Approx(0.02));
}
