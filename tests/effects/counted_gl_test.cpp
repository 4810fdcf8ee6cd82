// Texture reads of every effect at every level: programs that count them (PlanOptions::count_taps) draw the same picture,
// and miss none.
#include "hard_inputs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <regex>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// What stands before every call of such a name; textureSize() and the like read nothing.
std::vector<std::string> before_reads(const std::string& glsl) {
    static const std::regex read(R"(\b(texture(?!Size|Query)|texel|image)[A-Za-z]*\s*\()");
    static const std::string counting = "(++postfx_taps, ";
    std::vector<std::string> found;
    for (std::sregex_iterator at(glsl.begin(), glsl.end(), read), end; at != end; ++at) {
        const auto start = static_cast<std::size_t>(at->position());
        const std::size_t length = std::min(start, counting.size());
        found.push_back(glsl.substr(start - length, length));
    }
    return found;
}

void check_text(const Plan& plan) {
    for (const Pass& pass : plan.passes) {
        INFO(pass.name);
        REQUIRE(pass.program->counts_taps);
        const std::vector<std::string> before = before_reads(pass.program->text);
        CHECK(!before.empty()); // at least of the stored picture
        CHECK(std::all_of(before.begin(), before.end(),
                          [](const std::string& text) { return text == "(++postfx_taps, "; }));
    }
}

/// A pass that was drawn and has something to read has read; one that was not drawn has not.
void check_taps(const Plan& plan, const Report& report) {
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const PassReport& pass = report.passes[i];
        INFO(pass.name);
        REQUIRE(pass.taps.has_value());
        const bool drawn = pass.drawn.value_or(true) && pass.tiles_drawn.value_or(1) > 0;
        if (drawn && !plan.passes[i].inputs.empty()) CHECK(*pass.taps > 0);
        if (!drawn) CHECK(*pass.taps <= static_cast<std::uint64_t>(pass.tiles)); // what listing them read
        if (plan.passes[i].inputs.empty()) CHECK(*pass.taps == 0);
    }
}

} // namespace

TEST_CASE("counted is uncounted bit for bit and counts every read, for every effect and level") {
    for (const EffectPtr& effect : catalog().effects()) {
        const Input input = ordinary_input(effect->reads, usual_size, Camera::perspective(45, 0.1));
        PlanOptions counting = linear_output();
        counting.count_taps = true;
        Planner planner;
        Runner runner;
        Chain chain;
        chain.add(catalog(), effect->id);
        const int levels = std::max<int>(1, static_cast<int>(effect->levels.size()));
        for (int level = 0; level < levels; ++level) {
            CAPTURE(effect->id, level);
            chain.entries.front().level = level;
            runner.prepare(planner.plan(chain, facts_of(input), linear_output()));
            const Image plain = runner.draw(input);
            const Plan plan = planner.plan(chain, facts_of(input), counting);
            check_text(plan);
            runner.prepare(plan);
            CHECK(same_bits(runner.draw(input), plain));
            check_taps(plan, runner.report());
        }
    }
}
