// A scene file:
//
//     description: one line
//     include: other.yaml          # that scene first; what stands here replaces what has the same name there
//     terrain: {...}  paths: {name: {...}}  materials: {name: {...}}
//     background: {...}  ambient: [r, g, b]  camera: {...}
//     nodes: [{name, position, rotation, scale, look_at, mesh, material(s), light, animate, children}]
#include "read_parts.hpp"

#include <base/read_file.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace postfx::host {
namespace {

constexpr std::size_t max_nodes = 20000;
constexpr int max_depth = 64;
constexpr std::size_t max_file_bytes = std::size_t{8} << 20;

using Named = std::vector<std::pair<YamlValue, YamlValue>>;

/// The sections of a file with those of the files that it includes; nothing is interpreted yet.
struct Document {
    std::optional<YamlValue> description, terrain, background, ambient, camera;
    Named materials, paths;
    std::vector<YamlValue> nodes;
};

std::string name_of(const YamlValue& node) {
    if (!node.is_map()) return {};
    for (const auto& [key, value] : node.entries()) {
        if (key.text() == "name") return value.text();
    }
    return {};
}

void replace_or_add(Named& named, const std::pair<YamlValue, YamlValue>& entry) {
    const std::string name = entry.first.text();
    const auto same = std::find_if(named.begin(), named.end(),
                                   [&](const auto& other) { return other.first.text() == name; });
    if (same == named.end()) {
        named.push_back(entry);
    } else {
        *same = entry;
    }
}

std::string read_text(const std::filesystem::path& file) {
    return read_file(file, max_file_bytes, "a scene");
}

Document read_document(const std::string& text, const std::filesystem::path& origin,
                       std::vector<std::filesystem::path> including);

Document read_included(const YamlValue& name, const std::vector<std::filesystem::path>& including) {
    const std::filesystem::path file = name.named_file("a scene").lexically_normal();
    for (const std::filesystem::path& open : including) {
        if (std::filesystem::weakly_canonical(open) == std::filesystem::weakly_canonical(file)) {
            name.fail(fmt::format("{} includes itself", file.string()));
        }
    }
    return read_document(read_text(file), file, including);
}

Document read_document(const std::string& text, const std::filesystem::path& origin,
                       std::vector<std::filesystem::path> including) {
    const YamlMap map(parse_yaml(text, origin.string()), "scene",
                      {"description", "include", "terrain", "paths", "materials", "background", "ambient",
                       "camera", "nodes"});
    including.push_back(origin);
    Document document;
    if (const auto include = map.find("include")) document = read_included(*include, including);
    const auto take = [&](const char* key, std::optional<YamlValue>& target) {
        if (const auto found = map.find(key)) target = found;
    };
    take("description", document.description);
    take("terrain", document.terrain);
    take("background", document.background);
    take("ambient", document.ambient);
    take("camera", document.camera);
    if (const auto paths = map.find("paths")) {
        for (const auto& entry : paths->entries())
            replace_or_add(document.paths, entry);
    }
    if (const auto materials = map.find("materials")) {
        for (const auto& entry : materials->entries())
            replace_or_add(document.materials, entry);
    }
    if (const auto nodes = map.find("nodes")) {
        std::vector<YamlValue> kept;
        const auto added = nodes->list();
        for (const YamlValue& old : document.nodes) {
            const std::string name = name_of(old);
            const bool replaced =
                !name.empty() && std::any_of(added.begin(), added.end(), [&](const YamlValue& node) {
                    return name_of(node) == name;
                });
            if (!replaced) kept.push_back(old);
        }
        kept.insert(kept.end(), added.begin(), added.end());
        document.nodes = std::move(kept);
    }
    return document;
}

/// Turns a document into a scene.
class SceneReader {
public:
    explicit SceneReader(const ModelSource& read_model) { library_.read_model = read_model; }

    Scene read(const Document& document, const std::filesystem::path& origin) {
        scene_.file = origin;
        scene_.name = origin.stem().string();
        if (document.description) scene_.description = document.description->text();
        if (document.terrain) library_.terrain = read_terrain(*document.terrain);
        for (const auto& [name, value] : document.paths) {
            library_.paths[name.text()] = scene_.paths.size();
            scene_.paths.push_back(read_path(value, library_.terrain));
        }
        level_terrain(document);
        for (const auto& [name, value] : document.materials) {
            library_.materials[name.text()] = scene_.materials.size();
            scene_.materials.push_back(read_material(name.text(), value));
        }
        scene_.surroundings = read_surroundings(document.background, document.ambient);
        for (const YamlValue& node : document.nodes)
            read_node(node, std::nullopt, 1);
        if (document.camera) read_camera(*document.camera);
        return std::move(scene_);
    }

private:
    /// Paths on the terrain are roads or tracks: the ground follows them, a little lower so that it stays
    /// under them.
    void level_terrain(const Document& document) {
        constexpr double drop = 0.12;
        for (const auto& [name, value] : document.paths) {
            for (const auto& [key, option] : value.entries()) {
                if (key.text() == "on_terrain" && option.toggle()) {
                    library_.terrain->level(scene_.paths[library_.paths[name.text()]], drop);
                }
            }
        }
    }

    void read_node(const YamlValue& value, std::optional<std::size_t> parent, int depth) {
        const YamlMap map(value, "node",
                          {"name", "position", "rotation", "scale", "look_at", "mesh", "material",
                           "materials", "light", "animate", "children"});
        if (depth > max_depth) value.fail(fmt::format("nodes are nested more than {} deep", max_depth));
        if (scene_.nodes.size() == max_nodes)
            value.fail(fmt::format("a scene has at most {} nodes", max_nodes));
        Node node;
        node.parent = parent;
        node.local = read_transform(map);
        if (const auto animate = map.find("animate")) node.animation = read_animation(*animate, library_);
        if (const auto mesh = map.find("mesh")) {
            node.parts = read_mesh(*mesh, map.find("material"), map.find("materials"), scene_, library_);
        } else {
            for (const char* key : {"material", "materials"}) {
                if (const auto useless = map.find(key))
                    useless->fail("a node without a mesh has no material");
            }
        }
        const std::size_t index = scene_.nodes.size();
        if (const auto name = map.find("name")) {
            node.name = name->text();
            if (!node_names_.emplace(node.name, index).second) {
                name->fail(fmt::format("there is already a node \"{}\"", node.name));
            }
        }
        scene_.nodes.push_back(std::move(node));
        if (const auto mesh = map.find("mesh"))
            place_model(*mesh, map.find("material"), index, scene_, library_);
        if (const auto value_of_light = map.find("light")) {
            Light light = read_light(*value_of_light);
            light.node = index;
            scene_.lights.push_back(light);
            check_light_counts(*value_of_light);
        }
        if (const auto children = map.find("children")) {
            for (const YamlValue& child : children->list())
                read_node(child, index, depth + 1);
        }
    }

    void check_light_counts(const YamlValue& light) const {
        if (scene_.lights.size() > max_lights)
            light.fail(fmt::format("a scene has at most {} lights", max_lights));
        const auto shadows = std::count_if(scene_.lights.begin(), scene_.lights.end(),
                                           [](const Light& other) { return other.casts_shadow; });
        if (static_cast<std::size_t>(shadows) > max_shadows) {
            light.fail(fmt::format("at most {} lights of a scene cast shadows", max_shadows));
        }
    }

    static glm::dmat4 read_transform(const YamlMap& map) {
        glm::dvec3 position(0), turn(0), scale(1);
        map.read("position", position, any_length);
        map.read("rotation", turn, degrees);
        if (const auto factor = map.find("scale")) {
            scale = factor->is_list() ? factor->vector(any_length) : glm::dvec3(factor->number(any_length));
            if (scale.x == 0 || scale.y == 0 || scale.z == 0) factor->fail("a scale of 0 leaves nothing");
        }
        glm::dmat4 result(1);
        if (const auto target = map.find("look_at")) {
            if (map.has("rotation")) target->fail("a node has \"rotation\" or \"look_at\", not both");
            const glm::dvec3 look_at = target->vector(any_length);
            if (glm::length(look_at - position) < 1e-9) target->fail("look_at is the node's own position");
            result = look_at_matrix(position, look_at, {0, 1, 0});
        } else {
            result = glm::translate(result, position);
            result = glm::rotate(result, glm::radians(turn.y), {0, 1, 0});
            result = glm::rotate(result, glm::radians(turn.x), {1, 0, 0});
            result = glm::rotate(result, glm::radians(turn.z), {0, 0, 1});
        }
        return glm::scale(result, scale);
    }

    void read_camera(const YamlValue& value) {
        const YamlMap map(value, "camera",
                          {"parent", "animate", "position", "look_at", "up", "vertical_fov", "near", "far",
                           "orthographic_extent", "focus_distance"});
        SceneCamera& camera = scene_.camera;
        if (const auto parent = map.find("parent")) camera.parent = find_named(*parent, node_names_, "node");
        if (const auto animate = map.find("animate")) camera.animation = read_animation(*animate, library_);
        map.read("position", camera.position, any_length);
        map.read("look_at", camera.look_at, any_length);
        if (glm::length(camera.look_at - camera.position) < 1e-9)
            value.fail("the camera looks at its own position");
        map.read("up", camera.up, any_length);
        map.read("vertical_fov", camera.vertical_fov, {1, 170});
        map.read("near", camera.near_plane, {1e-4, 1e4});
        map.read("far", camera.far_plane, {1e-3, 1e6});
        if (const auto extent = map.find("orthographic_extent")) {
            if (map.has("vertical_fov"))
                extent->fail("a camera has \"vertical_fov\" or \"orthographic_extent\", not both");
            camera.orthographic_extent = extent->number(positive);
        } else if (const auto far_plane = map.find("far")) {
            far_plane->fail("only an orthographic camera has a far plane");
        }
        if (camera.orthographic_extent && camera.far_plane <= camera.near_plane)
            value.fail("far is nearer than near");
        if (const auto focus = map.find("focus_distance")) camera.focus_distance = focus->number({0.01, 1e6});
    }

    Scene scene_;
    Library library_;
    std::map<std::string, std::size_t> node_names_;
};

} // namespace

Scene parse_scene(const std::string& yaml, const std::filesystem::path& origin,
                  const ModelSource& read_model) {
    return SceneReader(read_model).read(read_document(yaml, origin, {}), origin);
}

Scene read_scene(const std::filesystem::path& file, const ModelSource& read_model) {
    return parse_scene(read_text(file), file, read_model);
}

std::string read_scene_description(const std::filesystem::path& file) {
    const Document document = read_document(read_text(file), file, {});
    return document.description ? document.description->text() : "";
}

} // namespace postfx::host
