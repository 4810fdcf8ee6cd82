// Texture reads that are counted while a picture is drawn are those that can be counted by hand.
#include <catch2/catch.hpp>

#include "execute_fixture.hpp"

#include <postfx/plugin.hpp>

#include <map>

using namespace execute_fixture;
using postfx::PassReport;
using postfx::Report;
using postfx::testing::constant;
using postfx::testing::same_bits;

namespace {

constexpr int width = 67, height = 41; // odd: quads of pixels stand over the edge
constexpr std::uint64_t pixels = width * height;

Report report_of(const Chain& chain, const Image& color, PlanOptions options = linear_output()) {
    options.count_taps = true;
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain, facts_of(color), options);
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs.of(plan));
    executor.run(inputs.of(plan)); // a frame's counts are its own
    return executor.report();
}

using Taps = std::map<std::string, std::uint64_t>;

Taps taps_of(const Report& report) {
    Taps taps;
    for (const PassReport& pass : report.passes) {
        REQUIRE(pass.taps.has_value());
        taps[pass.name] = *pass.taps;
    }
    return taps;
}

Taps taps_of(const Chain& chain, const Image& color) {
    return taps_of(report_of(chain, color));
}

void plan_probe(const postfx::Request&, postfx::Builder& out) {
    const postfx::PlanImage found =
        out.pass("pass", "probe_pass.glsl").reads("picture", out.color(), "nearest");
    out.compose("probe.glsl").reads("found", found, "nearest");
}

/// An effect with a pass of this body.
postfx::Catalog probe_catalog(const std::string& body, const std::string& before) {
    static constexpr auto probe = postfx::effect<plan_probe>("probe");
    static constexpr const postfx_effect* effects[] = {&probe};
    const std::string pass =
        before + "vec4 probe_pass(Pixel pixel, ProbePassParams params, sampler2D picture) {\n" + body + "}\n";
    const postfx_source sources[] = {
        {sizeof(postfx_source), 0, "probe_pass.glsl", pass.c_str(), ""},
        {sizeof(postfx_source), 0, "probe.glsl",
         "vec3 probe(vec3 color, Pixel pixel, ProbeParams params, sampler2D found) {\n"
         "    return texelFetch(found, pixel.index, 0).rgb;\n}\n",
         ""}};
    postfx::Catalog catalog;
    catalog.add({sizeof(postfx_module), POSTFX_ABI_MAJOR, POSTFX_ABI_MINOR, 1, effects, sources, 2,
                 sizeof(postfx_source)},
                "probe.so");
    return catalog;
}

/// Reads of a pass of this body, all pixels together.
std::uint64_t probed(const std::string& body, const Image& color, const std::string& before = "") {
    const postfx::Catalog catalog = probe_catalog(body, before);
    Chain chain;
    chain.add(catalog, "probe");
    return taps_of(chain, color).at("probe/pass");
}

/// 0, but for 1 in every column whose number `is_bright` agrees to.
template<class Bright>
Image striped(Bright is_bright) {
    Image image = constant(width, height, {0, 0, 0});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (is_bright(x)) image.at(x, y, 0) = 1;
        }
    }
    return image;
}

} // namespace

TEST_CASE("a copy reads each pixel once") {
    const Quiet quiet;
    CHECK(taps_of(chain_of({"tint"}), test_picture(width, height)) == Taps{{"tint", pixels}});
    CHECK(taps_of(report_of({}, test_picture(width, height), {.output = postfx::Output::display}))
          == Taps{{"output", pixels}});
}

TEST_CASE("what is not asked for is not counted") {
    const Quiet quiet;
    const Image picture = test_picture(width, height);
    const Inputs inputs(picture);
    const Plan plan = Planner().plan(chain_of({"tint"}), facts_of(picture), linear_output());
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs.of(plan));
    CHECK_FALSE(executor.report().passes.front().taps.has_value());
}

TEST_CASE("loops, fused passes and passes of other sizes") {
    const Quiet quiet;
    Chain chain = chain_of({"blur", "tint"});
    const Image picture = test_picture(width, height);
    for (const int radius : {1, 2, 5}) {
        chain.find("blur")->set("radius", radius);
        const auto line = static_cast<std::uint64_t>(2 * radius + 1);
        CHECK(
            taps_of(chain, picture)
            == Taps{{"blur/across", line * pixels}, {"blur/down", line * pixels}, {"blur+tint", 2 * pixels}});
    }
    chain.find("blur")->level = 0; // half the size, rounded up
    const std::uint64_t half = ((width + 1) / 2) * ((height + 1) / 2);
    chain.find("blur")->set("radius", 2);
    CHECK(taps_of(chain, picture)
          == Taps{{"blur/across", 5 * half}, {"blur/down", 5 * half}, {"blur+tint", 2 * pixels}});
    PlanOptions folded = linear_output();
    folded.fold = true;
    CHECK(taps_of(report_of(chain, picture, folded))
          == Taps{{"blur/across", 5 * half}, {"blur/down", 5 * half}, {"blur+tint", 2 * pixels}});
}

TEST_CASE("what ends early, or is never reached, is counted as it went") {
    const Quiet quiet;
    const Image stripes = striped([](int x) { return x % 10 == 9; });
    // Pixels look to the right until they find a bright column or the edge.
    std::uint64_t steps = 0;
    for (int x = 0; x < width; ++x)
        steps += static_cast<std::uint64_t>(std::min(9 - x % 10 + 1, width - x));
    CHECK(probed("    for (int x = pixel.index.x; x < pixel.size.x; ++x) {\n"
                 "        if (texelFetch(picture, ivec2(x, pixel.index.y), 0).r > 0.5) return vec4(x);\n"
                 "    }\n"
                 "    return vec4(0.0);\n",
                 stripes)
          == steps * height);
    constexpr std::uint64_t bright = 6 * height;
    CHECK(probed("    bool one = texelFetch(picture, pixel.index, 0).r > 0.5\n"
                 "            && texelFetch(picture, ivec2(0), 0).r < 0.5;\n"
                 "    return one ? texelFetch(picture, ivec2(1), 0) : vec4(0.0);\n",
                 stripes)
          == pixels + 2 * bright);
    CHECK(probed("    if (texture(picture, pixel.uv).r > 0.5) discard;\n"
                 "    return textureGather(picture, pixel.uv) + SUM(pixel.uv);\n",
                 stripes,
                 "#define SUM(uv) (textureLod(picture, uv, 0.0) + textureGrad(picture, uv, uv, uv))\n")
          == pixels + 3 * (pixels - bright));
}

TEST_CASE("a pass that never runs and one in tiles") {
    const Quiet quiet;
    const Image dark = constant(width, height, {0.5f, 0.5f, 0.5f});
    CHECK(taps_of(chain_of({"flare"}), dark)
          == Taps{{"census of the picture", pixels},
                  {"flare/decision", 0},
                  {"flare/bright", 0},
                  {"flare", 0},
                  {"copy", pixels}});

    Image spot = dark;
    spot.at(40, 20, 1) = 4;
    constexpr std::uint64_t tiles = 5 * 3, tile = 16 * 16;
    const Taps taps = taps_of(chain_of({"spots"}), spot);
    CHECK(taps
          == Taps{{"spots/tiles", tile * tiles},
                  {"spots/squares", tile + tiles}, // the mask is looked at once per tile
                  {"spots", 2 * pixels}});
}

TEST_CASE("a sum may be longer than 32 bits") {
    const Quiet quiet;
    CHECK(probed("    postfx_taps += 0x40000001u;\n    return vec4(0.0);\n", test_picture(width, height))
          == 0x40000001ull * pixels);
}

TEST_CASE("what could read unseen is refused, with the effect and the line") {
    const Image picture = test_picture(8, 8);
    CHECK_THROWS_WITH(
        probed("    return READ(texelFetch);\n", picture,
               "#define READ(function) function(picture, pixel.index, 0)\n"),
        Catch::Contains("probe_pass.glsl")
            && Catch::Contains("can't be counted: line 3: names texelFetch without calling it"));
    // It would read without counting; it does not compile.
    CHECK_THROWS_WITH(probed("    return texelFetch(picture, pixel.index, 0);\n", picture,
                             "vec4 texelFetch(sampler2D picture, ivec2 index, int level) {\n"
                             "    return textureLod(picture, vec2(0.5), 0.0);\n}\n"),
                      Catch::Contains("probe_pass.glsl"));
    gl::take_debug_messages(); // the driver tells it too
}

TEST_CASE("a counted picture is the picture bit for bit, watched or not") {
    const Quiet quiet;
    const Image picture = test_picture(width, height);
    for (const Chain& chain : {nine_effects(), chain_of({"flare", "spots", "curve"})}) {
        const SceneFacts facts = facts_of(picture);
        const Image plain = draw(chain, picture, facts);
        PlanOptions counting = linear_output();
        counting.count_taps = true;
        CHECK(same_bits(draw(chain, picture, facts, counting), plain));

        const Inputs inputs(picture);
        const Plan plan = Planner().plan(chain, facts, counting);
        Executor executor;
        executor.prepare(plan);
        executor.run(inputs.of(plan));
        const Taps unwatched = taps_of(executor.report());
        executor.run(inputs.of(plan), postfx::Timing::off, postfx::Watch::nonfinite);
        CHECK(taps_of(executor.report()) == unwatched);
    }
}
