// How programs are made to count their texture reads, and what is refused because a read could be missed.
#include <catch2/catch.hpp>

#include "fixtures.hpp"

#include <plan/taps.hpp>
#include <postfx/postfx.hpp>

#include <string>
#include <utility>
#include <vector>

using namespace postfx;
using postfx::testing::fixtures;

namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

} // namespace

TEST_CASE("every call that reads counts itself, whatever is in its brackets") {
    const Pairs texts = {
        {"", ""},
        {"a = texelFetch(p, i, 0).r;", "a = (++postfx_taps, texelFetch(p, i, 0)).r;"},
        {"texture (p, uv)", "(++postfx_taps, texture (p, uv))"},
        {"textureLod(\n  p, vec2(0.5), 0.0)", "(++postfx_taps, textureLod(\n  p, vec2(0.5), 0.0))"},
        {"textureGather(p, uv, 1)", "(++postfx_taps, textureGather(p, uv, 1))"},
        {"textureProjGradOffset(p, a, b, c, d)", "(++postfx_taps, textureProjGradOffset(p, a, b, c, d))"},
        {"texelFetchOffset(p, i, 0, o)", "(++postfx_taps, texelFetchOffset(p, i, 0, o))"},
        {"imageLoad(p, i)", "(++postfx_taps, imageLoad(p, i))"},
        {"imageAtomicAdd(p, i, 1u)", "(++postfx_taps, imageAtomicAdd(p, i, 1u))"},
        {"texelFetch(p, ivec2(texelFetch(q, f(i), 0).rg), 0)",
         "(++postfx_taps, texelFetch(p, ivec2((++postfx_taps, texelFetch(q, f(i), 0)).rg), 0))"},
        {"#define FETCH(i) texelFetch(p, (i), 0)\nFETCH(j)",
         "#define FETCH(i) (++postfx_taps, texelFetch(p, (i), 0))\nFETCH(j)"},
        {"texelFetch(p, /* texture( */ i, 0)", "(++postfx_taps, texelFetch(p,                i, 0))"},
        {"// texture(p, uv)\n", "                 \n"},
        {"if (a) discard;", "if (a) do { postfx_tell_taps(); discard; } while (false);"},
    };
    for (const auto& [glsl, counted] : texts) {
        INFO(glsl);
        const CountedText text = count_taps(glsl);
        CHECK(text.why_not.empty());
        CHECK(text.glsl == counted);
    }
}

TEST_CASE("what reads nothing is left as it is") {
    for (const std::string glsl :
         {"textureSize(p, 0)", "textureQueryLod(p, uv)", "textureQueryLevels(p)", "imageStore(p, i, v)",
          "imageSize(p)", "layout(rgba8) uniform image2D image_of_this;",
          "vec3 textured(vec3 texture_count);", "my_texelFetch(p)", "#include \"texture.glsl\"\n",
          "#if texture\n#endif\n", "f(1e5, 0x1f, 2.0f)"}) {
        INFO(glsl);
        const CountedText text = count_taps(glsl);
        CHECK(text.why_not.empty());
        CHECK(text.glsl == glsl);
    }
}

TEST_CASE("where a read could be missed, counting is refused and says where") {
    const Pairs texts = {
        {"\nCALL(texelFetch)", "line 2: names texelFetch without calling it"},
        {"#define CALL texture\n", "line 1: names texture without calling it"},
        {"float texture = 1.0;", "line 1: names texture without calling it"},
        {"a;\n#define FETCH(x) texel##x(p, i, 0)\n", "line 2: makes words in a macro"},
        {"#define OPEN f(\n", "line 1: leaves a bracket open"},
        {"#define CLOSE )\n", "line 1: closes a bracket that is not open"},
        {"f(1));", "line 1: closes a bracket that is not open"},
        {"texelFetch(p, i, 0;", "line 1: leaves a bracket open"},
        {"#extension GL_ARB_sparse_texture2 : enable\n", "line 1: has the directive #extension"},
        {"a; \\\n b;", "line 1: has a line continuation, which could hide a directive"},
        {"/* texelFetch(p, i, 0)", "line 1: has a comment without an end"},
    };
    for (const auto& [glsl, why] : texts) {
        INFO(glsl);
        CHECK(count_taps(glsl).why_not == why);
    }
}

TEST_CASE("a plan counts only when it is asked to, in programs of their own") {
    Chain chain;
    chain.add(fixtures(), "blur");
    SceneFacts facts;
    facts.width = facts.height = 64;
    Planner planner;
    const Plan plain = planner.plan(chain, facts);
    const Plan counting = planner.plan(chain, facts, {.count_taps = true});
    const Plan again = planner.plan(chain, facts);
    REQUIRE(plain.passes.size() == counting.passes.size());
    for (std::size_t i = 0; i < plain.passes.size(); ++i) {
        CHECK_FALSE(plain.passes[i].program->counts_taps);
        CHECK(counting.passes[i].program->counts_taps);
        CHECK(plain.passes[i].program->text.find("taps") == std::string::npos);
        CHECK(counting.passes[i].program->key != plain.passes[i].program->key);
        CHECK(again.passes[i].program == plain.passes[i].program);
        CHECK(counting.passes[i].uniform_block == plain.passes[i].uniform_block);
    }
    CHECK_FALSE(describe(counting).passes.front().taps.has_value()); // nothing was drawn
}
