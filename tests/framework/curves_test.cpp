// Curves: written, read strictly.
#include <catch2/catch.hpp>

#include "chain_fixture.hpp"

#include <postfx/curves.hpp>

#include <temporary_directory.hpp>

#include <fstream>

using postfx::Curves;

namespace {

Curves example() {
    Curves curves;
    curves.device = "a \"device\"";
    curves.driver = "4.5";
    curves.clock = "GL timestamps";
    curves.made_by = "postfx study";
    curves.base = {0.25, 1.5};
    curves.effects["glow"] = {{"low", {0.125, 2}, 0.1, 0.004}, {"high", {0.5, 3}, 0.01, 0}};
    curves.effects["tone"] = {{"", {0, 0.5}, 0, 0}};
    return curves;
}

/// What is said of the example with one piece of its text replaced.
std::string refusal(const std::string& piece, const std::string& other) {
    std::string text = curves_json(example());
    text.replace(text.find(piece), piece.size(), other);
    const postfx::testing::TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "curves.json";
    std::ofstream(file) << text;
    const std::string message = chain_fixture::error_of([&] { postfx::read_curves(file); });
    const std::string start = file.string() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

} // namespace

TEST_CASE("curves are read as they were written") {
    const postfx::testing::TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "curves.json";
    std::ofstream(file) << curves_json(example());
    const Curves curves = postfx::read_curves(file);
    CHECK(curves_json(curves) == curves_json(example()));
    CHECK(curves.device == "a \"device\"");
    REQUIRE(curves.find("glow", "high"));
    CHECK(curves.find("glow", "high")->time.at(2) == 6.5);
    CHECK(curves.find("glow", "high")->error == 0.01);
    CHECK_FALSE(curves.find("glow", "ultra"));
    CHECK_FALSE(curves.find("blur", "high"));
}

TEST_CASE("a time that grows faster than the picture is kept") {
    const postfx::testing::TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "curves.json";
    Curves curves = example();
    curves.effects["glow"][1].time = {1, 2, 1.5};
    std::ofstream(file) << curves_json(curves);
    CHECK(postfx::read_curves(file).find("glow", "high")->time.at(4) == Approx(1 + 2 * 8));
}

TEST_CASE("what is wrong with a file of curves is told") {
    CHECK(refusal("\"clock\"", "\"clok\"") == "curves has no key \"clok\"; did you mean \"clock\"?");
    CHECK(refusal("\"driver\": \"4.5\",", "") == "curves: \"driver\" is missing");
    CHECK(refusal("\"driver\": \"4.5\"", "\"driver\": 4.5") == "curves.driver: expected text, found 4.5");
    CHECK(refusal("0.125", "-0.125")
          == "effects.glow[0].fixed_ms: expected a number that is not negative, found -0.125");
    CHECK(refusal("0.125", "null")
          == "effects.glow[0].fixed_ms: expected a number that is not negative, found null");
    CHECK(refusal("0.01", "0.1") == "effects.glow[1].error: expected less than low's 0.1, found 0.1");
    CHECK(refusal("\"high\"", "\"low\"") == "effects.glow[1].level: \"low\" comes twice");
    CHECK(refusal("{", "[").starts_with("is not JSON: "));
    CHECK(refusal("\"base\": {", "\"base\": {\"ms\": 1,") == "base has no key \"ms\"");
}
