// The pictures that the scenes and the default chain make, against stored ones. Laws come first (plugins/*/test.cpp);
// these catch what no law names: a light that went out, an effect that stands in the wrong place.
#include <gl/context.hpp>
#include <scene/renderer.hpp>
#include <scene/scene.hpp>

#include <testing.hpp>

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>
#include <vector>

using namespace postfx;
using namespace postfx::testing;

namespace {

const std::string source = POSTFX_SOURCE_DIRECTORY;

/// The chain's picture of the scene at its start, display-linear: tone mapped, neither encoded nor dithered.
Image picture_of(const std::string& scene_name, const std::string& chain_name, int width, int height) {
    const host::Scene scene = host::read_scene(source + "/configs/scenes/" + scene_name + ".yaml");
    const Catalog catalog = Catalog::discover();
    const Chain chain = read_chain(source + "/configs/chains/" + chain_name + ".yaml", catalog);
    SceneFacts facts;
    facts.width = width;
    facts.height = height;
    facts.camera = scene.camera_at(0);
    facts.attachments = attachment_names();
    const Plan plan = Planner().plan(chain, facts, {.output = Output::linear});

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

struct Allowed {
    int codes;
    double differing_fraction;
    const char* reason;
};

constexpr Allowed same_rasteriser = {
    1, 0.001,
    "Mesa 22.3's llvmpipe gives the same codes with vectors of 128 and of 256 bits and with and without "
    "LLVM's "
    "optimiser; another LLVM may round a code, and a few on edges, otherwise"};
/// One lamp, tree or effect less moves more than this, too.
constexpr Allowed another_rasteriser = {
    3, 0.02, "another device covers edge pixels differently, and rounds rgba16f by a code or two"};

} // namespace

TEST_CASE("the scenes look as they did") {
    REQUIRE(has_gl());
    std::vector<std::string> scenes;
    for (const auto& file : std::filesystem::directory_iterator(source + "/configs/scenes"))
        scenes.push_back(file.path().stem().string());
    REQUIRE(!scenes.empty());
    const Allowed allowed = gl::current_device().software ? same_rasteriser : another_rasteriser;
    for (const std::string& scene : scenes) {
        INFO(scene);
        const Image picture = picture_of(scene, "cinematic", 320, 180);
        CHECK_NOTHROW(check_golden(source + "/tests/scene", scene, picture, allowed.codes,
                                   allowed.differing_fraction, allowed.reason));
    }
}
