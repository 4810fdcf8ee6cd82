// Properties of plans over random chains: every read gets what was meant to be read, and nothing crashes.
#include <catch2/catch.hpp>

#include "fixtures.hpp"

#include <plan/targets.hpp>

#include <postfx/postfx.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

using postfx::Chain;
using postfx::ChainEntry;
using postfx::Format;
using postfx::ImageRef;
using postfx::Plan;
using postfx::Planner;
using postfx::PlanOptions;
using postfx::SceneFacts;
using postfx::testing::fixtures;

namespace {

/// Reproducible on every standard library (distributions are not).
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(n)); }
    double unit() { return static_cast<double>(engine_()) / 4294967295.0; }
    template<class T>
    const T& one_of(const std::vector<T>& list) {
        return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
    }

private:
    std::mt19937 engine_;
};

/// What a texture would hold: a number that stands for "output o of that pass, given those inputs".
using Content = std::uint64_t;

Content content(const std::string& pass, int output, const std::vector<Content>& inputs) {
    std::string text = pass;
    text += '#';
    text += std::to_string(output);
    for (Content input : inputs) {
        text += ',';
        text += std::to_string(input);
    }
    return std::hash<std::string>{}(text);
}

Content attachment_content(const std::string& name) {
    return content(name, 0, {});
}

/// Draw the plan with contents instead of pixels.
Content simulate(const Plan& plan) {
    std::vector<Content> targets(plan.targets.size(), 0);
    const auto read = [&](const ImageRef& image) {
        REQUIRE(image.kind != ImageRef::Kind::none);
        REQUIRE(image.index >= 0);
        const auto index = static_cast<std::size_t>(image.index);
        return image.kind == ImageRef::Kind::target ? targets.at(index)
                                                    : attachment_content(plan.attachments.at(index));
    };
    for (const postfx::Pass& pass : plan.passes) {
        std::vector<Content> inputs;
        for (const postfx::PassInput& input : pass.inputs) {
            inputs.push_back(read(input.image));
            REQUIRE(std::find(pass.outputs.begin(), pass.outputs.end(), input.image) == pass.outputs.end());
        }
        for (std::size_t o = 0; o < pass.outputs.size(); ++o) {
            REQUIRE(pass.outputs[o].kind == ImageRef::Kind::target);
            REQUIRE(std::count(pass.outputs.begin(), pass.outputs.end(), pass.outputs[o]) == 1);
            const postfx::Target& target = plan.targets.at(static_cast<std::size_t>(pass.outputs[o].index));
            REQUIRE(target.width == pass.width);
            REQUIRE(target.height == pass.height);
            if (o == 0) REQUIRE(target.format == pass.format);
            targets.at(static_cast<std::size_t>(pass.outputs[o].index)) =
                content(pass.name, static_cast<int>(o), inputs);
        }
    }
    return read(plan.picture);
}

/// What the samplers of a fixture's compose function should see when the stored picture is `color`.
std::vector<Content> sides(const ChainEntry& entry, Content color) {
    const std::string& id = entry.effect->id;
    if (id == "shift") return {color};
    if (id == "blur") {
        return {content(entry.name + "/down", 0, {content(entry.name + "/across", 0, {color})})};
    }
    if (id == "split") {
        return {content(entry.name + "/parts", 0, {color}), content(entry.name + "/parts", 1, {color})};
    }
    if (id == "many") return std::vector<Content>(8, content(entry.name + "/ramp", 0, {}));
    if (id == "gauge") return {attachment_content("depth")};
    return {};
}

/// The picture's content by the meaning of the chain; only which effects share a pass is taken from the plan.
Content expected(const Plan& plan, Chain& chain) {
    Content color = attachment_content("color");
    for (const postfx::Pass& pass : plan.passes) {
        if (pass.name.find('/') != std::string::npos) continue;
        std::vector<Content> inputs = {color};
        for (std::size_t i = 0; i < pass.effects.size(); ++i) {
            const ChainEntry& entry = *chain.find(pass.effects[i]);
            const std::vector<Content> own = sides(entry, color);
            inputs.insert(inputs.end(), own.begin(), own.end());
            // What samples the stored picture must not have anything between it and the picture.
            if (i > 0) REQUIRE((own.empty() || entry.effect->id == "many" || entry.effect->id == "gauge"));
        }
        color = content(pass.name, 0, inputs);
    }
    return color;
}

Chain random_chain(Random& random, const std::vector<std::string>& effects, int longest) {
    Chain chain;
    for (int n = random.below(longest + 1); n > 0; --n) {
        ChainEntry& entry = chain.add(fixtures(), random.one_of(effects));
        entry.enabled = random.below(8) != 0;
        if (!entry.effect->levels.empty())
            entry.level = random.below(static_cast<int>(entry.effect->levels.size()));
        for (const postfx::ParameterInfo& parameter : entry.effect->parameters) {
            const double span = parameter.maximum - parameter.minimum;
            const std::vector<double> values = {parameter.minimum, parameter.maximum,
                                                parameter.default_value[0], parameter.identity.value_or(0),
                                                parameter.minimum + random.unit() * span};
            entry.set(parameter.id, random.one_of(values));
        }
    }
    return chain;
}

SceneFacts random_facts(Random& random) {
    SceneFacts facts;
    facts.width = random.one_of<int>({1, 2, 3, 64, 641, 16384});
    facts.height = random.one_of<int>({1, 2, 5, 48, 361, 16384});
    if (random.below(2)) facts.attachments.insert(facts.attachments.begin(), "depth");
    if (random.below(2)) facts.attachments.emplace_back("normal");
    facts.color_is_8bit = random.below(2) == 0;
    if (random.below(4) == 0) facts.camera = postfx::Camera::parallel(10, 0.1, 100);
    return facts;
}

PlanOptions random_options(Random& random) {
    PlanOptions options;
    options.working_format = random.below(2) ? Format::rgba16f : Format::rgba32f;
    options.output = random.below(2) ? postfx::Output::linear : postfx::Output::display;
    options.fuse = random.below(4) != 0;
    return options;
}

} // namespace

TEST_CASE("in 1000 random chains every read gets what was written for it") {
    const std::vector<std::string> effects = {"blur",    "curve", "gauge", "grown", "many",
                                              "plain_c", "shift", "split", "tint"};
    Random random(20240601);
    Planner planner;
    std::size_t shared = 0;
    for (int n = 0; n < 1000; ++n) {
        Chain chain = random_chain(random, effects, 12);
        const SceneFacts facts = random_facts(random);
        const Plan plan = planner.plan(chain, facts, random_options(random));
        INFO("chain " << n);
        REQUIRE(simulate(plan) == expected(plan, chain));
        std::size_t outputs = 0;
        for (const postfx::Pass& pass : plan.passes)
            outputs += pass.outputs.size();
        shared += outputs - plan.targets.size();
        for (const std::string& attachment : plan.attachments) {
            const bool known = std::find(facts.attachments.begin(), facts.attachments.end(), attachment)
                               != facts.attachments.end();
            REQUIRE(known);
        }
    }
    CHECK(shared > 1000); // or the test would have tested nothing
}

TEST_CASE("in 1000 random plans sharing and dropping change no picture") {
    Random random(7);
    std::size_t dropped = 0;
    for (int n = 0; n < 1000; ++n) {
        Plan plan;
        plan.attachments = {"color", "depth"};
        const int passes = 1 + random.below(12);
        for (int i = 0; i < passes; ++i) {
            postfx::Pass pass;
            pass.name = std::to_string(i);
            pass.width = pass.height = 1 + random.below(2);
            for (int inputs = random.below(4); inputs > 0; --inputs) {
                const int targets = static_cast<int>(plan.targets.size());
                const int choice = random.below(targets + 2);
                pass.inputs.push_back({"x", choice < targets
                                                ? ImageRef{ImageRef::Kind::target, choice}
                                                : ImageRef{ImageRef::Kind::attachment, choice - targets}});
            }
            for (int outputs = 1 + random.below(3); outputs > 0; --outputs) {
                pass.outputs.push_back({ImageRef::Kind::target, static_cast<int>(plan.targets.size())});
                plan.targets.push_back(
                    {pass.width, pass.height, random.below(3) ? Format::rgba16f : Format::r8});
            }
            pass.format = plan.targets[pass.outputs.front().index].format;
            plan.passes.push_back(std::move(pass));
        }
        plan.picture = {ImageRef::Kind::target, random.below(static_cast<int>(plan.targets.size()))};
        const Content before = simulate(plan);
        const std::size_t pass_count = plan.passes.size(), target_count = plan.targets.size();

        postfx::drop_unread_passes(plan);
        dropped += pass_count - plan.passes.size();
        postfx::share_targets(plan);
        postfx::keep_read_attachments(plan);
        INFO("plan " << n);
        REQUIRE(simulate(plan) == before);
        REQUIRE(plan.targets.size() <= target_count);
        // A pass is left only if the picture needs it.
        for (std::size_t i = 0; i < plan.passes.size(); ++i) {
            Plan without = plan;
            without.passes.erase(without.passes.begin() + static_cast<std::ptrdiff_t>(i));
            REQUIRE(simulate(without) != before);
        }
    }
    CHECK(dropped > 1000);
}

TEST_CASE("a target takes only what has its format") {
    Chain chain;
    for (int i = 0; i < 3; ++i)
        chain.add(fixtures(), "split"); // parts are rgba32f and rgba16f
    SceneFacts facts;
    facts.width = 8;
    facts.height = 8;
    const Plan plan = Planner().plan(chain, facts, {.output = postfx::Output::linear});
    REQUIRE(plan.passes.size() == 6);
    for (const postfx::Pass& pass : plan.passes) {
        CHECK(plan.targets[pass.outputs[0].index].format == pass.format);
        if (pass.outputs.size() == 2) {
            CHECK(plan.targets[pass.outputs[0].index].format == Format::rgba32f);
            CHECK(plan.targets[pass.outputs[1].index].format == Format::rgba16f);
        }
    }
    // One for the float32 part; the other part, the picture before and the picture after are alive together.
    CHECK(plan.targets.size() == 4);
    CHECK(plan.texture_bytes() == 8 * 8 * (16 + 3 * 8));
}

TEST_CASE("500 random chains of good and faulty effects end in a plan or an Error") {
    const std::vector<std::string> all = fixtures().ids();
    std::vector<std::string> good = all;
    std::erase_if(good, [](const std::string& id) {
        return fixtures().find(id)->module_path.filename() == "postfx_fixture_faulty.so";
    });
    REQUIRE(good.size() < all.size());
    Random random(99);
    Planner planner;
    int plans = 0, errors = 0;
    for (int n = 0; n < 500; ++n) {
        // Mostly good, so that not every chain ends at its first effect.
        Chain chain = random_chain(random, random.below(3) ? good : all, 9);
        const SceneFacts facts = random_facts(random);
        try {
            const Plan plan = planner.plan(chain, facts, random_options(random));
            simulate(plan);
            (void)report_text(describe(plan));
            ++plans;
        } catch (const postfx::Error& error) {
            CHECK(std::string(error.what()).find('\n') == std::string::npos);
            CHECK_FALSE(error.place().effect.empty());
            ++errors;
        }
    }
    CHECK(plans > 100);
    CHECK(errors > 50);
}
