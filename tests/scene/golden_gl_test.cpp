// The pictures that the scenes and the default chain make, against stored ones. Laws come first (plugins/*/test.cpp);
// these catch what no law names: a light that went out, an effect that stands in the wrong place.
#include <scene/renderer.hpp>
#include <scene/scene.hpp>

#include <testing.hpp>

#include <catch2/catch.hpp>

#include <string>

using namespace postfx;
using namespace postfx::testing;

namespace {

const std::string source = POSTFX_SOURCE_DIRECTORY;

/// The chain's picture of the scene at its start, display-linear: tone mapped, neither encoded nor dithered.
Image picture_of(const std::string& scene_name, const std::string& chain_name, int width, int height) {
    const host::Scene scene = host::read_scene(source + "/configs/scenes/" + scene_name + ".yaml");
    const Catalog catalog = Catalog::discover();
    const Chain chain = read_chain(source + "/configs/chains/" + chain_name + ".yaml", catalog);
    Facts facts;
    facts.width = width;
    facts.height = height;
    facts.camera = scene.camera_at(0);
    facts.attachments = host::SceneRenderer::attachment_names();
    facts.output = Output::linear;
    const Plan plan = Planner().plan(chain, facts);

    host::SceneRenderer renderer(scene);
    const host::SceneFrame frame = renderer.render(width, height, 0, plan.attachments);
    FrameInputs inputs;
    inputs.camera = facts.camera;
    for (const std::string& name : plan.attachments)
        inputs.textures.push_back(frame.texture(name));
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs);
    return executor.read_picture();
}

} // namespace

TEST_CASE("the scenes look as they did") {
    REQUIRE(has_gl());
    const std::string scene = GENERATE("night_drive", "cornell", "cornell_glow", "still_life");
    // Another rasteriser covers edge pixels differently, and rounds rgba16f differently by a code or two elsewhere: 3
    // codes are allowed anywhere, more in 2 % of the pixels. One lamp, tree or effect less moves more than that.
    CHECK_NOTHROW(check_golden(source + "/tests/scene", scene, picture_of(scene, "cinematic", 320, 180), 3,
                               0.02, "edge pixels and half-float rounding of other drivers"));
}
