#include "open_scene.hpp"

#include "model_process.hpp"

#include "run/resources.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

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

} // namespace postfx::host
