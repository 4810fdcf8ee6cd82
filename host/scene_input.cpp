#include "scene_input.hpp"

#include "model_process.hpp"
#include "number_checks.hpp"
#include "resources.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace postfx::host {
namespace {

void take_camera(Scene& scene, const std::string& name) {
    std::vector<std::string> known;
    for (const NamedCamera& camera : scene.cameras) {
        if (std::find(camera.names.begin(), camera.names.end(), name) != camera.names.end()) {
            scene.camera = camera.camera;
            return;
        }
        known.insert(known.end(), camera.names.begin(), camera.names.end());
    }
    throw Error(Place{.file = scene.file.string()},
                fmt::format("it has no camera \"{}\"{}; {}", name, did_you_mean(name, known),
                            known.empty() ? "it has none to choose from"
                                          : fmt::format("it has {}", fmt::join(known, ", "))));
}

} // namespace

void SceneOptions::declare(CLI::App& app) {
    auto* scene = app.add_option("SCENE", default_scene_.empty() ? scene_ : default_scene_,
                                 "A name from configs/scenes/, a scene file, or a model (glTF, OBJ, ...)");
    if (default_scene_.empty()) scene->required();
    app.add_option("--size", size_, "Of the picture, pixels")->type_name("WxH")->capture_default_str();
    app.add_option("--time", time_, "Seconds after the scene's start")
        ->check(finite())
        ->capture_default_str();
    app.add_option("--camera", camera_,
                   "A camera of the model by its name, instead of one that sees all of it")
        ->type_name("NAME");
    app.add_flag("--strict", strict_, "Refuse a scene of whose files something would be left out");
    app.add_flag("--no-fuse", no_fuse_, "Let every effect write its own target");
}

Scene open_known_scene(const std::string& scene, bool strict, const std::string& camera) {
    Scene opened = open_scene(scene, data_directory() / "configs/scenes", read_model_in_child);
    if (!camera.empty()) take_camera(opened, camera);
    if (strict && !opened.losses.empty()) {
        throw Error(fmt::format("{} (--strict refuses what is left out)", fmt::join(opened.losses, "; ")));
    }
    for (const std::string& loss : opened.losses)
        fmt::print(stderr, "postfx: {}\n", loss);
    return opened;
}

Scene SceneOptions::open() const {
    return open_known_scene(default_scene_.empty() ? scene_ : default_scene_, strict_, camera_);
}

Facts SceneOptions::facts(const Scene& scene, ViewBounds& bounds, Output output) const {
    Facts facts = facts_of(scene, bounds, parse_size(size_), time_, output);
    facts.fuse = !no_fuse_;
    return facts;
}

Facts facts_of(const Scene& scene, ViewBounds& bounds, Size size, double time, Output output) {
    Facts facts;
    facts.width = size.width;
    facts.height = size.height;
    facts.attachments = SceneRenderer::attachment_names();
    facts.output = output;
    look(facts, bounds, scene.camera_at(time), time);
    return facts;
}

void look(Facts& facts, ViewBounds& bounds, const Camera& camera, double time) {
    facts.camera = camera;
    facts.scene = bounds.at(time, camera, facts.width, facts.height);
}

TrialInputs trial_inputs(SceneRenderer& renderer, const Facts& facts, double time) {
    TrialInputs inputs;
    inputs.frame.camera = facts.camera;
    inputs.frame.time = time;
    inputs.draw_scene = [&renderer, facts, time](const std::vector<std::string>& attachments) {
        return textures_of(
            renderer.render(facts.width, facts.height, time, attachments, CameraOverride{facts.camera, {}}));
    };
    return inputs;
}

Textures textures_of(const SceneFrame& frame) {
    Textures textures;
    for (const SceneAttachment& attachment : frame.attachments)
        textures[attachment.name] = attachment.texture;
    return textures;
}

} // namespace postfx::host
