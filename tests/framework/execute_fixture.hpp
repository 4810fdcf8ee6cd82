// Chains of fixtures on the executor, for its tests.
#pragma once

#include <catch2/catch.hpp>

#include "fixtures.hpp"

#include <gl/context.hpp>
#include <gl/objects.hpp>
#include <testing.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace execute_fixture {

namespace gl = postfx::gl;
using postfx::Chain;
using postfx::Executor;
using postfx::Format;
using postfx::Image;
using postfx::Plan;
using postfx::Planner;
using postfx::PlanOptions;
using postfx::SceneFacts;
using postfx::testing::fixtures;
using postfx::testing::linear_output;

inline SceneFacts facts_of(const Image& color) {
    SceneFacts facts;
    facts.width = color.width;
    facts.height = color.height;
    facts.attachments = {"color", "depth"};
    return facts;
}

inline Chain chain_of(const std::vector<std::string>& effects) {
    Chain chain;
    for (const std::string& effect : effects)
        chain.add(fixtures(), effect);
    return chain;
}

/// Nine effects with every kind of pass.
inline Chain nine_effects() {
    return chain_of({"blur", "tint", "split", "plain_c", "shift", "tint", "curve", "many", "gauge"});
}

inline Image four_channels(const Image& image) {
    Image result(image.width, image.height, 4, 1.0f);
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        std::copy_n(&image.values[3 * i], 3, &result.values[4 * i]);
    return result;
}

/// Input textures for any plan of the fixtures.
class Inputs {
public:
    explicit Inputs(const Image& color)
        : color_(color.width, color.height, Format::rgba32f),
          depth_(color.width, color.height, Format::r32f) {
        color_.upload(color.channels == 4 ? color : four_channels(color));
        depth_.upload(postfx::testing::constant(color.width, color.height, {0.25f}));
    }
    postfx::FrameInputs of(const Plan& plan) const {
        postfx::FrameInputs inputs;
        for (const std::string& name : plan.attachments)
            inputs.textures.push_back(name == "depth" ? depth_.name() : color_.name());
        return inputs;
    }

private:
    gl::Texture color_, depth_;
};

inline Image draw(const Chain& chain, const Image& color, const SceneFacts& facts,
                  const PlanOptions& options = linear_output()) {
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain, facts, options);
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs.of(plan));
    return executor.read_picture();
}

inline Image test_picture(int width = 67, int height = 41) {
    return postfx::testing::noise(width, height, 0, 4, 5);
}

/// Every test ends with nothing to complain about.
struct Quiet {
    Quiet() { gl::take_debug_messages(); }
    ~Quiet() {
        for (const std::string& message : gl::take_debug_messages())
            FAIL_CHECK("OpenGL says: " << message);
    }
};

} // namespace execute_fixture
