#include "scene_options.hpp"

#include "input/open_scene.hpp"
#include "terminal/number_checks.hpp"

namespace postfx::host {

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

Scene SceneOptions::open() const {
    return open_known_scene(default_scene_.empty() ? scene_ : default_scene_, strict_, camera_);
}

SceneFacts SceneOptions::facts(const Scene& scene, ViewBounds& bounds) const {
    return facts_of(scene, bounds, parse_size(size_), time_);
}

} // namespace postfx::host
