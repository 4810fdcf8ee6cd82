#include "scene_input.hpp"

#include "number_checks.hpp"
#include "resources.hpp"

namespace postfx::host {

void SceneOptions::declare(CLI::App& app) {
    auto* scene = app.add_option("SCENE", default_scene_.empty() ? scene_ : default_scene_,
                                 "A name from configs/scenes/, a scene file, or a model (glTF, OBJ, ...)");
    if (default_scene_.empty()) scene->required();
    app.add_option("--size", size_, "Of the picture, pixels")->type_name("WxH")->capture_default_str();
    app.add_option("--time", time_, "Seconds after the scene's start")
        ->check(finite())
        ->capture_default_str();
    app.add_flag("--no-fuse", no_fuse_, "Let every effect write its own target");
}

Scene SceneOptions::open() const {
    return open_scene(default_scene_.empty() ? scene_ : default_scene_, data_directory() / "configs/scenes");
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
