#include "assets.hpp"
#include "file_kind.hpp"
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
    for (const Part& part : scene.nodes.front().parts) {
        const Mesh& mesh = *part.mesh;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position);
            const glm::dvec3 b(mesh.vertices[mesh.indices[i + 1]].position);
            const glm::dvec3 c(mesh.vertices[mesh.indices[i + 2]].position);
            visit(part, glm::cross(b - a, c - a));
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

/// Share of white light that the model's surface reflects, 0..1. Textures count as the usual.
double reflectance(const Scene& scene) {
    double sum = 0, area = 0;
    for_each_face(scene, [&](const Part& part, glm::dvec3 face) {
        const Material& material = scene.materials[part.material];
        const double tint = glm::dot(glm::dvec3(material.diffuse), glm::dvec3(0.2126, 0.7152, 0.0722));
        sum += glm::length(face) * (material.diffuse_texture ? usual_reflectance : 1) * tint;
        area += glm::length(face);
    });
    return area > 0 ? sum / area : usual_reflectance;
}

/// How far from the middle of the box, towards `from`, a square picture of that field of view holds all of it.
double fitting_distance(const Bounds& bounds, glm::dvec3 from, double vertical_fov) {
    const glm::dmat4 view = look_at_matrix(from, glm::dvec3(0), {0, 1, 0});
    const glm::dvec3 right(view[0]), up(view[1]), half(0.5f * (bounds.high - bounds.low));
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

/// A model alone, in front of grey: seen a little from above and the side and lit from the front left; or, when it is
/// open to one side as a room is, looked at and lit through that.
Scene scene_around_model(const std::filesystem::path& file, const std::string& content) {
    Model model = load_model(file, content);
    Scene scene;
    scene.file = file;
    scene.name = file.stem().string();
    scene.description = fmt::format("the model {}", input_name(file.filename()));
    scene.materials = std::move(model.materials);
    Node node;
    node.name = scene.name;
    for (const ModelPart& part : model.parts)
        node.parts.push_back({part.mesh, part.material});
    scene.nodes.push_back(std::move(node));

    const Bounds bounds = scene.bounds();
    const double radius = std::max(static_cast<double>(bounds.radius()), 1e-6);
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

    // Less light on what is bright, so that white stays below a display's white; dark things may be dark.
    const auto exposure =
        static_cast<float>(usual_reflectance / std::max(reflectance(scene), usual_reflectance));
    const glm::dvec3 key = is_room ? turned(-0.35, 0.25, 1) : turned(-0.6, 0.9, 1);
    add_directional(scene, key, exposure * glm::vec3(1.9f, 1.8f, 1.65f), 2.4 * radius, true);
    add_directional(scene, turned(1, 0.3, 0.5), exposure * glm::vec3(0.35f, 0.4f, 0.5f), 0, false);
    if (!is_room)
        add_directional(scene, turned(0.5, 0.8, -1), exposure * glm::vec3(1.0f, 1.0f, 1.1f), 0, false);
    scene.surroundings.zenith = {0.34f, 0.36f, 0.4f};
    scene.surroundings.horizon = {0.16f, 0.165f, 0.17f};
    scene.surroundings.ground = {0.07f, 0.07f, 0.07f};
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
Scene read_scene_or_model(const std::filesystem::path& file) {
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
    Scene scene = kind.holds == FileKind::Holds::model ? scene_around_model(file, content)
                  : content.empty()                    ? read_scene(file)
                                                       : parse_scene(content, input_name(file));
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

Scene open_scene(const std::string& argument, const std::filesystem::path& scenes_directory) {
    const std::filesystem::path path(argument);
    if (argument == "-" || path.has_extension() || path.has_parent_path()) return read_scene_or_model(path);
    const std::filesystem::path named = scenes_directory / (argument + ".yaml");
    if (std::filesystem::is_regular_file(named)) return read_scene(named);
    if (std::filesystem::exists(path)) return read_scene_or_model(path);
    std::vector<std::string> names;
    for (const SceneEntry& entry : list_scenes(scenes_directory))
        names.push_back(entry.name);
    throw Error(fmt::format("there is no scene \"{}\"{}; known: {}", argument, did_you_mean(argument, names),
                            fmt::join(names, ", ")));
}

} // namespace postfx::host
