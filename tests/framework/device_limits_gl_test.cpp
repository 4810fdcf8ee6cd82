// What a device can't do is told with its limit and the pass that wants more.
#include "execute_fixture.hpp"

#include <execute/device_limits.hpp>

#include <postfx/error.hpp>

using namespace execute_fixture;
using postfx::DeviceLimits;

namespace {

SceneFacts facts_of_size(int width, int height) {
    SceneFacts facts = facts_of(Image(1, 1, 3));
    facts.width = width;
    facts.height = height;
    return facts;
}

std::string error_of(const Plan& plan, const DeviceLimits& limits) {
    try {
        postfx::check_limits(plan, limits);
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "no error";
}

constexpr DeviceLimits usual = {.texture_side = 16384,
                                .viewport_width = 16384,
                                .viewport_height = 16384,
                                .textures = 16,
                                .outputs = 8,
                                .uniform_bytes = 16384};

} // namespace

TEST_CASE("a limit is told with the pass that wants more") {
    const Plan wide = Planner().plan(chain_of({"blur"}), facts_of_size(20000, 10), linear_output());
    const std::string first = wide.passes.at(0).name;
    CHECK(error_of(wide, usual) == first + ": wants 20000 pixels, this device has at most 16384");
    const Plan high = Planner().plan(chain_of({"blur"}), facts_of_size(10, 20000), linear_output());
    CHECK(error_of(high, usual) == first + ": wants 20000 pixels, this device has at most 16384");

    const Plan plan = Planner().plan(chain_of({"blur", "tint"}), facts_of_size(640, 360), linear_output());
    CHECK(error_of(plan, usual) == "no error");
    DeviceLimits small = usual;
    small.viewport_height = 200;
    CHECK_THAT(error_of(plan, small), Catch::Contains("wants 360 pixels, this device has at most 200"));
    small = usual;
    small.textures = 0;
    CHECK_THAT(error_of(plan, small), Catch::Contains("textures, this device has at most 0"));
    small = usual;
    small.outputs = 0;
    CHECK_THAT(error_of(plan, small), Catch::Contains("outputs, this device has at most 0"));
    small = usual;
    small.uniform_bytes = 1;
    CHECK_THAT(error_of(plan, small), Catch::Contains("bytes of uniforms, this device has at most 1"));
}

TEST_CASE("a plan beyond this device is refused before anything is made, and the plan before stays") {
    const Quiet quiet;
    const DeviceLimits limits = postfx::device_limits();
    CHECK(limits.texture_side >= 16384); // what OpenGL 4.5 promises, as of the others
    CHECK(limits.textures >= 16);
    CHECK(limits.outputs >= 8);
    CHECK(limits.uniform_bytes >= 16384);
    if (limits.texture_side >= 32768) return; // plans have no more
    const Image color = test_picture();
    const Plan plan = Planner().plan(chain_of({"blur"}), facts_of(color), linear_output());
    const Inputs inputs(color);
    postfx::Executor executor;
    executor.prepare(plan);
    const Plan wide =
        Planner().plan(chain_of({"blur"}), facts_of_size(limits.texture_side + 1, 2), linear_output());
    CHECK_THROWS_WITH(executor.prepare(wide),
                      Catch::Contains("wants " + std::to_string(limits.texture_side + 1)
                                      + " pixels, this device has at most "
                                      + std::to_string(limits.texture_side)));
    executor.run(inputs.of(plan));
    CHECK(executor.read_picture().width == color.width);
}
