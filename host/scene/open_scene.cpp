#include "file_kind.hpp"
#include "memory_file.hpp"
#include "model.hpp"
#include "scene.hpp"

#include <base/read_file.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

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
    light.shadow_softness = 2;
    light.shadow_extent = static_cast<float>(extent);
    Node node;
    node.local = look_at_matrix(from, {0, 0, 0}, {0, 1, 0});
    scene.nodes.push_back(std::move(node));
    scene.lights.push_back(light);
}

/// For every triangle of a model: its part, and its normal as long as twice its area.
template<class Visit>
void for_each_face(const Scene& scene, Visit visit) {
    std::vector<glm::dmat4> placed;
    scene.place_nodes(0, placed);
    for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
        const glm::dmat3 to_world(placed[node]);
        const double handedness = glm::determinant(to_world) < 0 ? -1 : 1;
        for (const Part& part : scene.nodes[node].parts) {
            const auto mesh = scene.mesh_at(node, part.mesh, placed, 0);
            for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
                const auto corner = [&](std::size_t k) {
                    return to_world * glm::dvec3(mesh->vertices[mesh->indices[i + k]].position);
                };
                visit(part, handedness * glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
            }
        }
    }
}

/// Where a model is open: the sum of its faces' directions, which is 0 for a closed surface, as a share of its area. A
/// room without its front wall gives the way out of it.
glm::dvec3 opening(const Scene& scene) {
    glm::dvec3 sum(0);
    double area = 0;
    for_each_face(scene, [&](const Part&, glm::dvec3 face) {
        sum += face;
        area += glm::length(face);
    });
    return area > 0 ? sum / area : sum;
}

/// What the light is set for: about the mean reflectance of wood, leather, skin and painted metal.
constexpr double usual_reflectance = 0.25;

/// Of a surface whose metalness no texture says: metal reflects nothing diffusely.
double metal_share(const Material& material) {
    return material.metal_rough && !material.metal_roughness_texture ? static_cast<double>(material.metalness)
                                                                     : 0;
}

/// Share of white light that the model's surface reflects, 0..1. Textures count as the usual.
double reflectance(const Scene& scene) {
    double sum = 0, area = 0;
    for_each_face(scene, [&](const Part& part, glm::dvec3 face) {
        const Material& material = scene.materials[part.material];
        const double tint = (1 - metal_share(material))
                            * glm::dot(glm::dvec3(material.diffuse), glm::dvec3(0.2126, 0.7152, 0.0722));
        sum += glm::length(face) * (material.diffuse_texture ? usual_reflectance : 1) * tint;
        area += glm::length(face);
    });
    return area > 0 ? sum / area : usual_reflectance;
}

/// How far from the middle of the box, towards `from`, a square picture of that field of view holds all of it.
double fitting_distance(const Bounds& bounds, glm::dvec3 from, double vertical_fov) {
    const glm::dmat4 view = look_at_matrix(from, glm::dvec3(0), {0, 1, 0});
    const glm::dvec3 right(view[0]), up(view[1]), half(0.5 * (bounds.high - bounds.low));
    const double tan_half = std::tan(glm::radians(vertical_fov / 2));
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 place =
            half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const double away = std::max(std::abs(glm::dot(place, right)), std::abs(glm::dot(place, up)));
        distance = std::max(distance, glm::dot(place, from) + 1.08 * away / tan_half); // with a margin
    }
    return distance;
}

/// As many lights as a scene has, the first of them with shadows.
void limit_lights(Scene& scene) {
    std::size_t shadows = 0;
    if (scene.lights.size() > max_lights) {
        scene.losses.push_back(fmt::format("{}: {} lights are left out, for a scene has at most {}",
                                           scene.file.string(), scene.lights.size() - max_lights,
                                           max_lights));
        scene.lights.resize(max_lights);
    }
    for (Light& light : scene.lights)
        light.casts_shadow = light.kind != Light::Kind::point && shadows++ < max_shadows;
}

/// A model alone, in front of grey: seen a little from above and the side and lit from the front left; or, when it is
/// open to one side as a room is, looked at and lit through that. A model with lights of its own has those instead. It is
/// read from `readable`, which is `file` but for what came through a pipe.
Scene scene_around_model(const std::filesystem::path& file, const std::filesystem::path& readable,
                         const ModelSource& read_model) {
    Scene scene;
    scene.file = file;
    scene.name = file.stem().string();
    scene.description = fmt::format("the model {}", input_name(file.filename()));
    const Model model = read_model(readable);
    add_model(scene, model);
    for (const std::string& loss : model.losses)
        scene.losses.push_back(fmt::format("{}: {}", input_name(file), loss));
    limit_lights(scene);

    const Bounds bounds = scene.bounds();
    const double radius = bounds.radius() > 0 ? bounds.radius() : 1;
    const glm::dvec3 center(bounds.center());
    const glm::dvec3 out = opening(scene);
    const bool is_room = std::hypot(out.x, out.z) > 0.08; // small holes of a closed model stay below that
    const double yaw = is_room ? std::atan2(out.x, out.z) : 0;
    const auto turned = [&](double x, double y, double z) {
        return glm::dvec3(glm::rotate(glm::dmat4(1), yaw, {0, 1, 0}) * glm::dvec4(x, y, z, 0));
    };
    scene.camera.vertical_fov = 35;
    const glm::dvec3 from = glm::normalize(is_room ? turned(0.06, 0.05, 1) : turned(0.42, 0.2, 1));
    const double distance = fitting_distance(bounds, from, scene.camera.vertical_fov);
    scene.camera.look_at = center;
    scene.camera.position = center + distance * from;
    scene.camera.near_plane = 0.01 * radius;
    scene.camera.focus_distance = distance;

    scene.surroundings.zenith = {0.34f, 0.36f, 0.4f};
    scene.surroundings.horizon = {0.16f, 0.165f, 0.17f};
    scene.surroundings.ground = {0.07f, 0.07f, 0.07f};
    scene.flying_speed = 1.2 * radius;
    for (Light& light : scene.lights) {
        light.shadow_extent = static_cast<float>(2.4 * radius);
        light.shadow_near = static_cast<float>(1e-3 * radius);
    }
    if (!scene.lights.empty()) return scene; // the file's own light, and no other

    // Less light on what is bright, so that white stays below a display's white; dark things may be dark.
    const auto exposure =
        static_cast<float>(usual_reflectance / std::max(reflectance(scene), usual_reflectance));
    const glm::dvec3 key = is_room ? turned(-0.35, 0.25, 1) : turned(-0.6, 0.9, 1);
    add_directional(scene, key, exposure * glm::vec3(1.9f, 1.8f, 1.65f), 2.4 * radius, true);
    add_directional(scene, turned(1, 0.3, 0.5), exposure * glm::vec3(0.35f, 0.4f, 0.5f), 0, false);
    if (!is_room)
        add_directional(scene, turned(0.5, 0.8, -1), exposure * glm::vec3(1.0f, 1.0f, 1.1f), 0, false);
    scene.surroundings.ambient_up = exposure * glm::vec3(0.28f, 0.29f, 0.31f);
    scene.surroundings.ambient_down = exposure * glm::vec3(0.1f, 0.1f, 0.095f);
    return scene;
}

/// A stream's whole content, which comes only once; else "".
std::string content_of_stream(const std::filesystem::path& file) {
    constexpr std::size_t max_bytes = std::size_t{1} << 31; // a model with its textures, not an endless pipe
    return is_stream(file) ? read_file(file, max_bytes, "a scene or a model") : std::string();
}

/// A scene or model of the user, by its content.
Scene read_scene_or_model(const std::filesystem::path& file, const ModelSource& read_model) {
    constexpr const char* expected = "a scene (YAML) or a model (glTF, OBJ, ...)";
    std::string content = content_of_stream(file);
    const std::string start = content.empty() ? read_start(file, recognized_bytes, expected) : content;
    std::error_code unknown;
    const std::uintmax_t bytes = content.empty() ? std::filesystem::file_size(file, unknown) : content.size();
    const FileKind kind = recognize(start, bytes, file);
    const Place place{.file = input_name(file)};
    if (start.empty()) throw Error(place, fmt::format("is empty, expected {}", expected));
    if (kind.holds == FileKind::Holds::something_else) {
        throw Error(place, kind.what.empty() ? fmt::format("expected {}", expected)
                                             : fmt::format("is {}, expected {}", kind.what, expected));
    }
    if (kind.holds == FileKind::Holds::model) {
        if (content.empty()) return scene_around_model(file, file, read_model);
        const MemoryFile kept(content);
        Scene scene = scene_around_model(file, kept.path(), read_model);
        scene.content = std::move(content);
        return scene;
    }
    Scene scene =
        content.empty() ? read_scene(file, read_model) : parse_scene(content, input_name(file), read_model);
    scene.content = std::move(content);
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

Scene open_scene(const std::string& argument, const std::filesystem::path& scenes_directory,
                 const ModelSource& read_model) {
    const std::filesystem::path path(argument);
    if (argument == "-" || path.has_extension() || path.has_parent_path())
        return read_scene_or_model(path, read_model);
    const std::filesystem::path named = scenes_directory / (argument + ".yaml");
    if (std::filesystem::is_regular_file(named)) return read_scene(named, read_model);
    if (std::filesystem::exists(path)) return read_scene_or_model(path, read_model);
    std::vector<std::string> names;
    for (const SceneEntry& entry : list_scenes(scenes_directory))
        names.push_back(entry.name);
    throw Error(fmt::format("there is no scene \"{}\"{}; known: {}", argument, did_you_mean(argument, names),
                            fmt::join(names, ", ")));
}

} // namespace postfx::host
