// Programs compiled on a second thread: everything that will be drawn and nothing else, and never another picture.
#include <catch2/catch.hpp>

#include "execute_fixture.hpp"

#include <execute/warm_up.hpp>
#include <temporary_directory.hpp>

#include <postfx/error.hpp>

#include <bit>
#include <chrono>
#include <set>
#include <thread>

using namespace execute_fixture;
using postfx::ImageRef;
using postfx::ProgramCache;
using postfx::SmallPlan;
using postfx::StandIn;
using postfx::WarmUp;
using postfx::testing::TemporaryDirectory;

namespace {

/// As Inputs makes them.
std::vector<Format> formats_of(const Plan& plan) {
    std::vector<Format> formats;
    for (const std::string& name : plan.attachments)
        formats.push_back(name == "depth" ? Format::r32f : Format::rgba32f);
    return formats;
}

/// Every kind of pass: drawn always, by a decision, in tiles.
Chain all_kinds() {
    return chain_of({"blur", "tint", "flare", "split", "spots", "near", "curve", "many"});
}

std::set<std::uint64_t> programs_of(const Plan& plan) {
    std::set<std::uint64_t> keys;
    for (const postfx::Pass& pass : plan.passes)
        keys.insert(pass.program->key);
    return keys;
}

bool is_power_of_two(int side) {
    return std::has_single_bit(static_cast<unsigned>(side));
}

void check_stands_for(const StandIn& small, int width, int height, Format format) {
    CHECK(small.format == format);
    CHECK(small.width <= 4);
    CHECK(small.height <= 4);
    CHECK(is_power_of_two(small.width) == is_power_of_two(width));
    CHECK(is_power_of_two(small.height) == is_power_of_two(height));
}

std::string message_of(Executor& executor, const Plan& plan, const std::vector<Format>& formats) {
    try {
        executor.prepare(plan, formats);
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "it was prepared";
}

} // namespace

TEST_CASE("A small plan keeps what drivers compile for, and no condition") {
    for (const int width : {64, 67}) {
        const Image color = test_picture(width, 41);
        const Plan plan = Planner().plan(all_kinds(), facts_of(color), linear_output());
        const std::vector<Format> formats = formats_of(plan);
        for (std::size_t i = 0; i < plan.passes.size(); ++i) {
            INFO(plan.passes[i].name);
            const postfx::Pass& pass = plan.passes[i];
            const SmallPlan small = postfx::small_plan(plan, {i}, formats);
            REQUIRE(small.plan.passes.size() == 1);
            const postfx::Pass& alone = small.plan.passes[0];
            CHECK(alone.program == pass.program);
            CHECK(alone.condition.empty());
            CHECK(alone.uniform_block == pass.uniform_block);
            REQUIRE(alone.inputs.size() == pass.inputs.size());
            REQUIRE(alone.outputs.size() == pass.outputs.size());
            for (std::size_t input = 0; input < pass.inputs.size(); ++input) {
                CHECK(alone.inputs[input].linear == pass.inputs[input].linear);
                const StandIn& stand_in = small.inputs.at(alone.inputs[input].image.index);
                const ImageRef& image = pass.inputs[input].image;
                if (image.kind == ImageRef::Kind::attachment) {
                    check_stands_for(stand_in, plan.width, plan.height, formats[image.index]);
                } else {
                    const postfx::Target& target = plan.targets[image.index];
                    check_stands_for(stand_in, target.width, target.height, target.format);
                }
            }
            for (std::size_t output = 0; output < pass.outputs.size(); ++output) {
                const postfx::Target& target = plan.targets[pass.outputs[output].index];
                const postfx::Target& tiny = small.plan.targets.at(alone.outputs[output].index);
                check_stands_for({tiny.width, tiny.height, tiny.format}, target.width, target.height,
                                 target.format);
            }
        }
    }
}

TEST_CASE("All programs of a plan are compiled on the second thread, and found by whoever draws them") {
    const Quiet quiet;
    const TemporaryDirectory directory;
    if (ProgramCache(directory.path()).directory().empty()) {
        WARN("skipped: this driver hands on no programs");
        return;
    }
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(all_kinds(), facts_of(color), linear_output());
    const int all = static_cast<int>(programs_of(plan).size());
    {
        WarmUp warm_up(plan, formats_of(plan), directory.path());
        // Long enough for a slow machine; where nothing comes, the test fails.
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (warm_up.warmed() < all && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        CHECK(warm_up.warmed() == all);
    }
    Executor executor(directory.path());
    executor.prepare(plan);
    CHECK(executor.report().programs->compiled == 0);
    executor.run(inputs.of(plan));
    CHECK(postfx::testing::same_bits(executor.read_picture(), draw(all_kinds(), color, facts_of(color))));
}

TEST_CASE("A pass that is left to the caller is not compiled on the second thread any more") {
    const TemporaryDirectory directory;
    const Image color = test_picture();
    const Plan plan = Planner().plan(all_kinds(), facts_of(color), linear_output());
    WarmUp warm_up(plan, formats_of(plan), directory.path());
    for (std::size_t i = 0; i < plan.passes.size(); ++i)
        warm_up.leave(i); // returns: whatever the thread is at comes to an end
    const int warmed = warm_up.warmed();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(warm_up.warmed() == warmed);
}

TEST_CASE("With a second thread the picture is the same bit for bit, and programs are counted") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    for (const Chain& chain : {all_kinds(), nine_effects()}) {
        const TemporaryDirectory directory;
        const Plan plan = Planner().plan(chain, facts_of(color), linear_output());
        const Image expected = draw(chain, color, facts_of(color));
        for (int run = 0; run < 2; ++run) {
            Executor executor(directory.path());
            executor.prepare(plan, formats_of(plan));
            for (int frame = 0; frame < 2; ++frame) {
                executor.run(inputs.of(plan));
                CHECK(postfx::testing::same_bits(executor.read_picture(), expected));
            }
            const postfx::ProgramCount count = *executor.report().programs;
            CHECK(count.all >= static_cast<int>(programs_of(plan).size()));
            const bool hands_on = !ProgramCache(directory.path()).directory().empty();
            CHECK(count.compiled == (run == 0 || !hands_on ? count.all : 0));
            if (count.compiled == 0) CHECK(count.warmed == 0);
        }
    }
}

TEST_CASE("What does not compile is told once, in the words that it always has") {
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan bad = Planner().plan(chain_of({"tint", "broken_shader"}), facts_of(color), linear_output());
    const Plan good = Planner().plan(all_kinds(), facts_of(color), linear_output());
    Executor plain;
    const std::string expected = message_of(plain, bad, {});
    CHECK_THAT(expected, Catch::Contains("broken_shader.glsl:4"));

    const TemporaryDirectory directory;
    Executor executor(directory.path());
    for (int attempt = 0; attempt < 2; ++attempt)
        CHECK(message_of(executor, bad, formats_of(bad)) == expected);
    executor.prepare(good, formats_of(good));
    executor.run(inputs.of(good));
    CHECK(postfx::testing::same_bits(executor.read_picture(), draw(all_kinds(), color, facts_of(color))));
    gl::take_debug_messages(); // Mesa repeats the compiler's errors there
}

TEST_CASE("A second thread that can do nothing leaves everything to the first") {
    const Quiet quiet;
    const TemporaryDirectory directory;
    const Image color = test_picture();
    const Plan bad = Planner().plan(chain_of({"tint", "broken_shader"}), facts_of(color), linear_output());
    WarmUp warm_up(bad, formats_of(bad), directory.path());
    for (std::size_t i = 0; i < bad.passes.size(); ++i)
        warm_up.leave(i);
    CHECK(warm_up.warmed() < static_cast<int>(programs_of(bad).size()));
}
