// docs/write-an-effect.md: its effects build out of tree and do what the page says; what it calls refused is.
#include "markdown.hpp"

#include <plugin/pointwise.hpp>
#include <testing.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <set>

namespace fs = std::filesystem;
using namespace postfx;
using namespace postfx::testing;

namespace {

const std::vector<CodeBlock>& page() {
    static const std::vector<CodeBlock> blocks =
        code_blocks(POSTFX_SOURCE_DIRECTORY "/docs/write-an-effect.md");
    return blocks;
}

void check_success(const Outcome& outcome) {
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.status == 0);
}

/// The page's effects as a newcomer makes them: `postfx new`, then the page's files over the template's.
class Guide {
public:
    Guide() {
        for (const CodeBlock& block : page()) {
            const fs::path file = block.value("file");
            if (file.has_parent_path()) effects_.insert(file.begin()->string());
        }
        for (const std::string& effect : effects_) {
            check_success(run_program({"new", effect}, scratch_.path()));
            for (const char* of_template : {"reference.cpp", "test.cpp"})
                fs::remove(scratch_.path() / effect / of_template);
        }
        for (const CodeBlock& block : page()) {
            if (block.value("file").empty()) continue;
            const fs::path file = scratch_.path() / block.value("file");
            fs::create_directories(file.parent_path());
            std::ofstream(file) << block.text;
        }
        build();
        // The harness looks for effects once, when it is first used.
        ::setenv("POSTFX_PLUGIN_PATH",
                 ((scratch_ / "build/postfx_plugins").string() + ":" POSTFX_BUILD_DIRECTORY "/postfx_plugins")
                     .c_str(),
                 1);
    }

    const std::set<std::string>& effects() const { return effects_; }
    fs::path file(const std::string& name) const { return scratch_.path() / name; }

private:
    void build() const {
        std::ofstream all(scratch_.path() / "CMakeLists.txt");
        all << "cmake_minimum_required(VERSION 3.25)\nproject(guide LANGUAGES CXX)\nenable_testing()\n";
        for (const std::string& effect : effects_)
            all << "add_subdirectory(" << effect << ")\n";
        all.close();
        check_success(
            run_command({"cmake", "-S", ".", "-B", "build", "-G", "Ninja",
                         "-Dpostfx_DIR=" POSTFX_BUILD_DIRECTORY, "-DCMAKE_CXX_COMPILER=" POSTFX_CXX_COMPILER},
                        scratch_.path()));
        check_success(run_command({"cmake", "--build", "build"}, scratch_.path()));
    }

    TemporaryDirectory scratch_;
    std::set<std::string> effects_;
};

const Guide& guide() {
    static const Guide built;
    return built;
}

Input input_of(Image color) {
    Input input;
    input.color = std::move(color);
    return input;
}

bool no_gl() {
    std::string why;
    if (has_gl(&why)) return false;
    skip_case("no GL 4.5 context: " + why);
    return true;
}

} // namespace

TEST_CASE("guide: the effects are found, and say what the page says of them") {
    const Catalog catalog = (guide(), Catalog::discover());
    for (const std::string& effect : guide().effects()) {
        INFO(effect);
        CHECK(catalog.find(effect));
    }
    CHECK(catalog.find("haze")->reads == std::vector<std::string>{"depth"});
    CHECK(catalog.find("letterbox")->stage == EffectStage::display);
    CHECK(catalog.find("soft_focus")->levels.size() == 2);

    // "At most 40 lines of C++" is what the project promises for a pointwise effect.
    const std::string source = file_bytes(guide().file("contrast/contrast.cpp"));
    CHECK(std::count(source.begin(), source.end(), '\n') <= 40);
}

TEST_CASE("guide: the page's own test passes") {
    const Outcome tested =
        run_command({"ctest", "--test-dir", "build", "--output-on-failure"}, guide().file(""));
    check_success(tested);
    CHECK_THAT(tested.out, Catch::Contains("0 tests failed out of 1"));
}

TEST_CASE(
    "guide: a truth compiles with what the page says that it includes, outside of the tree it is left out") {
    const std::string source = POSTFX_SOURCE_DIRECTORY;
    std::vector<std::string> compile = {
        POSTFX_CXX_COMPILER,       "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only",
        "contrast/truth/truth.cpp"};
    for (const char* folder : {"/host", "/framework/include", "/framework/src"})
        compile.push_back("-I" + source + folder);
    check_success(run_command(compile, guide().file("")));
    const Outcome configured = run_command({"cmake", "-S", ".", "-B", "build"}, guide().file(""));
    check_success(configured);
    CHECK_THAT(configured.out, Catch::Contains("contrast: truth/ is left out"));
}

TEST_CASE("guide: an effect's own entry of the study comes along with its module") {
    CHECK_THAT(file_bytes(guide().file("build/postfx_plugins/postfx_contrast.study.yaml")),
               Catch::Contains("contrast: 1.5"));
}

TEST_CASE("guide: the plan is the one that the page prints") {
    const auto shown = std::find_if(page().begin(), page().end(),
                                    [](const CodeBlock& block) { return !block.value("explain").empty(); });
    REQUIRE(shown != page().end());
    const Catalog catalog = (guide(), Catalog::discover());
    SceneFacts facts;
    facts.width = 1280;
    facts.height = 720;
    facts.attachments = {"color", "depth"};
    const Plan plan = Planner().plan(read_chain(guide().file(shown->value("explain")), catalog), facts);
    CHECK_THAT(squeezed(report_text(describe(plan))), Catch::Contains(squeezed(shown->text)));
}

TEST_CASE("guide: what the page calls refused is refused for that reason") {
    int count = 0;
    for (const CodeBlock& block : page()) {
        if (block.info != "refused") continue;
        ++count;
        INFO("docs/write-an-effect.md:" << block.line);
        const std::string reason = block.text.substr(3, block.text.find('\n') - 3); // "// uses dFdx"
        CHECK_THAT(why_not_pointwise(block.text), Catch::Contains(reason));
    }
    CHECK(count == 7);
}

TEST_CASE("guide: haze leaves 2 % of the contrast at the visibility, and of the sky nothing") {
    guide();
    if (no_gl()) return;
    constexpr float light = 5;
    const float air[] = {0.6f, 0.7f, 0.8f};
    Input input = input_of(constant(7, 5, {light, light, light}));
    const auto raw = [&](double z) { return static_cast<float>(input.camera.depth_at(z)); };
    input.attachments["depth"] = constant(7, 5, {raw(100)});
    input.attachments["depth"].at(0, 0, 0) = raw(std::numeric_limits<double>::infinity());
    const Image result = run_effect("haze", input, {{"visibility", 100}});
    // Pixel 6, 2 is 3 pixels to the right of the middle, half the height is 2.5.
    const double slope = 3 / 2.5 * input.camera.tan_half_fov();
    for (int c = 0; c < 3; ++c) {
        const auto expected = [&](double distance) {
            return air[c] + (light - air[c]) * std::exp(-3.912 * distance / 100);
        };
        // exp of about -4 in float32 has a relative error of a few times 2^-22.
        CHECK(result.at(3, 2, c) == Approx(expected(100)).epsilon(1e-6));
        CHECK(result.at(6, 2, c) == Approx(expected(100 * std::hypot(1.0, slope))).epsilon(1e-6));
        CHECK(result.at(0, 0, c) == air[c]);
    }
    input.attachments.clear();
    CHECK(plan_effect("haze", input).effects.front().reason == "there is no depth");
}

TEST_CASE("guide: soft_focus spreads light evenly and no pixel that is not finite") {
    guide();
    if (no_gl()) return;
    const Values strong = {{"amount", 1}, {"radius", 0.01}};
    Input input = input_of(impulse(201, 201, 100, 100, 1.0f));
    const Image spread = run_effect("soft_focus", input, strong);
    CHECK(spread.at(100, 100, 0) < 0.2f);
    CHECK(spread.at(100, 100, 0) > spread.at(102, 100, 0));
    // Texture coordinates are filtered with 8 bits.
    CHECK(spread.at(102, 100, 0) == Approx(spread.at(98, 100, 0)).epsilon(1.0 / 256));
    CHECK(spread.at(100, 102, 0) == Approx(spread.at(100, 98, 0)).epsilon(1.0 / 256));

    input.color.at(100, 100, 1) = std::numeric_limits<float>::quiet_NaN();
    const std::string quality = GENERATE(as<std::string>(), "low", "high");
    const Image clean = run_effect("soft_focus", input, {{"quality", quality}});
    int not_finite = 0;
    for (float value : clean.values)
        not_finite += !std::isfinite(value);
    CHECK(not_finite == 1);
}

TEST_CASE("guide: crisp is steeper at edges and stays between its neighbours") {
    guide();
    if (no_gl()) return;
    const Image color = noise(23, 17, 0.0f, 8.0f);
    Image64 expected(color.width, color.height, 3);
    constexpr double amount = 1.5;
    for (int y = 0; y < color.height; ++y) {
        for (int x = 0; x < color.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                double sum = 0, low = 1e9, high = -1e9;
                for (int i = 0; i < 9; ++i) {
                    const double light = color.at(std::clamp(x + i % 3 - 1, 0, color.width - 1),
                                                  std::clamp(y + i / 3 - 1, 0, color.height - 1), c);
                    sum += light;
                    low = std::min(low, light);
                    high = std::max(high, light);
                }
                const double here = color.at(x, y, c);
                expected.at(x, y, c) = std::clamp(here + amount * (here - sum / 9), low, high);
            }
        }
    }
    const Worst worst =
        worst_difference(run_effect("crisp", input_of(color), {{"amount", amount}}), expected);
    // A sum of 9 numbers below 8 has at most 9 roundings of 72 2^-24; divided by 9 and times 1.5, and a few more.
    CHECK(worst.absolute < 12 * 12 * 0x1p-24);
}

TEST_CASE("guide: sparkle adds to bright light, and leaves frames without it alone") {
    guide();
    if (no_gl()) return;
    Input input{.color = noise(70, 50, 0, 3)};
    CHECK(same_bits(run_effect("sparkle", input), input.color)); // the threshold is 4
    input.color.at(60, 40, 1) = 10;
    const Image result = run_effect("sparkle", input);
    CHECK(result.at(60, 40, 1) == 10 + 0.5f * 6);
    CHECK(result.at(60, 40, 0) == input.color.at(60, 40, 0));
    CHECK(result.at(3, 3, 1) == input.color.at(3, 3, 1));
}

TEST_CASE("guide: shake moves the picture by the angle that the camera sees") {
    guide();
    if (no_gl()) return;
    constexpr int width = 30, height = 20, pixels = 3;
    const double per_degree = std::tan(std::numbers::pi / 180);
    // One degree is to be three pixels.
    const double tan_half_fov = per_degree * height / (2 * pixels);
    Input input = input_of(noise(width, height, 0.0f, 1.0f));
    input.camera = Camera::perspective(2 * std::atan(tan_half_fov) * 180 / std::numbers::pi, 0.1);
    const Image turned = run_effect("shake", input, {{"yaw", 1}, {"pitch", -1}});
    for (int y = pixels; y < height; ++y) {
        for (int x = 0; x + pixels < width; ++x) {
            // Filtering weighs neighbours, which differ by 1 at most, with 8 bits.
            CHECK(std::abs(turned.at(x, y, 0) - input.color.at(x + pixels, y - pixels, 0)) <= 2.0 / 256);
        }
    }
    input.camera = Camera::parallel(10, 0.1, 100);
    CHECK(plan_effect("shake", input, {{"yaw", 1}}).effects.front().status == EffectStatus::skipped);
}

TEST_CASE("guide: letterbox covers whole rows and refuses to cover all") {
    guide();
    const Input input = input_of(constant(4, 10, {0.5f, 0.25f, 0.125f}));
    CHECK_THROWS_WITH(plan_effect("letterbox", input, {{"top", 0.6}, {"bottom", 0.4}}),
                      Catch::Contains("leave nothing of the picture"));
    CHECK(plan_effect("letterbox", input, {{"top", 0.04}, {"bottom", 0}}).effects.front().status
          == EffectStatus::skipped);
    if (no_gl()) return;
    const Image result = run_effect("letterbox", input, {{"top", 0.2}, {"bottom", 0.1}, {"bar.2", 0.75}});
    for (int y = 0; y < 10; ++y) {
        const bool bar = y == 0 || y >= 8;
        INFO("row " << y);
        CHECK(result.at(2, y, 0) == (bar ? 0.0f : 0.5f));
        CHECK(result.at(2, y, 2) == (bar ? 0.75f : 0.125f));
    }
}
