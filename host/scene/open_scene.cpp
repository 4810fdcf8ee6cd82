#include "assets.hpp"
#include "scene.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

bool is_scene_file(const std::filesystem::path& file) {
    return file.extension() == ".yaml" || file.extension() == ".yml";
}

void add_directional(Scene& scene, glm::dvec3 from, glm::vec3 color, double extent, bool shadow) {
    Light light;
    light.kind = Light::Kind::directional;
    light.node = scene.nodes.size();
    light.color = color;
    light.casts_shadow = shadow;
    light.shadow_extent = static_cast<float>(extent);
    Node node;
    node.local = look_at_matrix(from, {0, 0, 0}, {0, 1, 0});
    scene.nodes.push_back(std::move(node));
    scene.lights.push_back(light);
}

/// A model alone: seen a little from above and the side, lit from the front left, in front of grey.
Scene scene_around_model(const std::filesystem::path& file) {
    Model model = load_model(file);
    Scene scene;
    scene.file = file;
    scene.name = file.stem().string();
    scene.description = fmt::format("the model {}", file.filename().string());
    scene.materials = std::move(model.materials);
    Node node;
    node.name = scene.name;
    for (const ModelPart& part : model.parts)
        node.parts.push_back({part.mesh, part.material});
    scene.nodes.push_back(std::move(node));

    const Bounds bounds = scene.bounds();
    const double radius = std::max(static_cast<double>(bounds.radius()), 1e-6);
    const glm::dvec3 center(bounds.center());
    const double distance = radius / std::sin(glm::radians(scene.camera.vertical_fov / 2));
    scene.camera.vertical_fov = 35;
    scene.camera.look_at = center;
    scene.camera.position = center + 1.12 * distance * glm::normalize(glm::dvec3(0.42, 0.2, 1));
    scene.camera.near_plane = 0.01 * radius;
    scene.camera.focus_distance = glm::length(scene.camera.position - center);

    add_directional(scene, {-0.6, 0.9, 1}, {1.9f, 1.8f, 1.65f}, 2.4 * radius, true);
    add_directional(scene, {1, 0.3, 0.5}, {0.35f, 0.4f, 0.5f}, 0, false);
    add_directional(scene, {0.5, 0.8, -1}, {1.0f, 1.0f, 1.1f}, 0, false);
    scene.surroundings.zenith = {0.34f, 0.36f, 0.4f};
    scene.surroundings.horizon = {0.16f, 0.165f, 0.17f};
    scene.surroundings.ground = {0.07f, 0.07f, 0.07f};
    scene.surroundings.ambient_up = {0.28f, 0.29f, 0.31f};
    scene.surroundings.ambient_down = {0.1f, 0.1f, 0.095f};
    return scene;
}

} // namespace

std::vector<SceneEntry> list_scenes(const std::filesystem::path& scenes_directory) {
    std::vector<SceneEntry> entries;
    std::error_code problem;
    for (const auto& item : std::filesystem::directory_iterator(scenes_directory, problem)) {
        if (is_scene_file(item.path())) entries.push_back({item.path().stem().string(), {}, item.path()});
    }
    std::sort(entries.begin(), entries.end(),
              [](const SceneEntry& a, const SceneEntry& b) { return a.name < b.name; });
    for (SceneEntry& entry : entries) {
        try {
            entry.description = read_scene_description(entry.file);
        } catch (const Error& error) {
            entry.description = error.what();
        }
    }
    return entries;
}

Scene open_scene(const std::string& argument, const std::filesystem::path& scenes_directory) {
    const std::filesystem::path path(argument);
    if (!path.has_extension() && !path.has_parent_path()) {
        const std::filesystem::path named = scenes_directory / (argument + ".yaml");
        if (std::filesystem::is_regular_file(named)) return read_scene(named);
        std::vector<std::string> names;
        for (const SceneEntry& entry : list_scenes(scenes_directory))
            names.push_back(entry.name);
        throw Error(fmt::format("there is no scene \"{}\"{}; known: {}", argument,
                                did_you_mean(argument, names), fmt::join(names, ", ")));
    }
    if (!std::filesystem::is_regular_file(path))
        throw Error({argument, 0, 0, {}, {}}, "there is no such file");
    if (is_scene_file(path)) return read_scene(path);
    if (is_model_file(path)) return scene_around_model(path);
    throw Error({argument, 0, 0, {}, {}}, "expected a scene (.yaml) or a model (.gltf, .glb, .obj, ...)");
}

} // namespace postfx::host
