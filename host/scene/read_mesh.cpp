#include "read_parts.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <functional>

namespace postfx::host {
namespace {

/// What a mesh of the file turned out to be: one mesh without slots, or parts by slot.
struct Context {
    const Scene& scene;
    const Library& library;
};

const Path& path_of(const YamlMap& map, const Context& context) {
    return context.scene.paths[find_named(map.at("path"), context.library.paths, "path")];
}

const Terrain& terrain_of(const YamlMap& map, const Context& context) {
    if (!context.library.terrain)
        map.value().fail("this stands on the terrain, and the scene has no \"terrain\"");
    return *context.library.terrain;
}

MadeParts one(Mesh mesh) {
    MadeParts parts;
    parts.push_back({"", std::move(mesh)});
    return parts;
}

MadeParts read_box(const YamlValue& value, const Context&) {
    const YamlMap map(value, "box", {"size"});
    glm::vec3 size(1);
    map.read("size", size, positive);
    return one(box(size));
}

MadeParts read_sphere(const YamlValue& value, const Context&) {
    const YamlMap map(value, "sphere", {"radius", "segments"});
    float radius = 0.5f;
    int segments = 32;
    map.read("radius", radius, positive);
    map.read("segments", segments, {4, 512});
    return one(sphere(radius, segments));
}

MadeParts read_plane(const YamlValue& value, const Context&) {
    const YamlMap map(value, "plane", {"size", "divisions"});
    glm::vec2 size(1);
    int divisions = 1;
    map.read("size", size, positive);
    map.read("divisions", divisions, {1, 500});
    return one(plane(size, divisions));
}

MadeParts read_cylinder(const YamlValue& value, const Context&) {
    const YamlMap map(value, "cylinder", {"radius", "height", "segments"});
    float radius = 0.5f, height = 1;
    int segments = 32;
    map.read("radius", radius, positive);
    map.read("height", height, positive);
    map.read("segments", segments, {3, 512});
    return one(cylinder(radius, height, segments));
}

MadeParts read_cone(const YamlValue& value, const Context&) {
    const YamlMap map(value, "cone", {"radius", "height", "segments"});
    float radius = 0.5f, height = 1;
    int segments = 32;
    map.read("radius", radius, positive);
    map.read("height", height, positive);
    map.read("segments", segments, {3, 512});
    return one(cone(radius, height, segments));
}

MadeParts read_torus(const YamlValue& value, const Context&) {
    const YamlMap map(value, "torus", {"radius", "tube", "segments"});
    float radius = 0.5f, tube = 0.15f;
    int segments = 32;
    map.read("radius", radius, positive);
    map.read("tube", tube, positive);
    map.read("segments", segments, {3, 512});
    return one(torus(radius, tube, segments));
}

MadeParts read_lathe(const YamlValue& value, const Context&) {
    const YamlMap map(value, "lathe", {"profile", "segments"});
    std::vector<glm::vec2> profile;
    const YamlValue list = map.at("profile");
    for (const YamlValue& point : list.list()) {
        profile.emplace_back(point.pair(any_length));
        if (profile.back().x < 0) point.fail("expected [radius, y] with a radius of at least 0");
    }
    if (profile.size() < 2 || profile.size() > 1000)
        list.fail(fmt::format("expected 2 to 1000 points, found {}", profile.size()));
    int segments = 48;
    map.read("segments", segments, {3, 512});
    return one(lathe(profile, segments));
}

MadeParts read_faces(const YamlValue& value, const Context&) {
    Mesh mesh;
    for (const YamlValue& face : value.list()) {
        std::vector<glm::vec3> corners;
        for (const YamlValue& corner : face.list())
            corners.emplace_back(corner.vector(any_length));
        if (corners.size() < 3)
            face.fail(fmt::format("a face has at least 3 corners, found {}", corners.size()));
        mesh.face(corners);
    }
    if (mesh.empty()) value.fail("expected at least one face");
    return one(std::move(mesh));
}

MadeParts read_terrain_mesh(const YamlValue& value, const Context& context) {
    return make_terrain(terrain_of(YamlMap(value, "terrain", {}), context));
}

MadeParts read_road(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "road", {"path", "width", "dash_length", "dash_gap", "line_width"});
    RoadOptions options;
    map.read("width", options.width, {0.5, 100});
    map.read("dash_length", options.dash_length, {0, 100});
    map.read("dash_gap", options.dash_gap, {0.1, 100});
    map.read("line_width", options.line_width, {0.01, 1});
    return make_road(path_of(map, context), options);
}

MadeParts read_tree(const YamlValue& value, const Context&) {
    const YamlMap map(value, "tree", {"seed", "kind", "height"});
    TreeOptions options;
    map.read("seed", options.seed);
    if (const auto kind = map.find("kind")) options.kind = kind->choice({"conifer", "broadleaf"});
    map.read("height", options.height, {0.1, 200});
    return make_tree(options);
}

MadeParts read_forest(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "forest",
                      {"path", "seed", "count", "clearance", "depth", "conifers", "height_range"});
    ForestOptions options;
    map.read("seed", options.seed);
    map.read("count", options.count, {0, 20000});
    map.read("clearance", options.clearance, from_zero);
    map.read("depth", options.depth, from_zero);
    map.read("conifers", options.conifers, share);
    map.read("height_range", options.height_range, {0.1, 200});
    return make_forest(terrain_of(map, context), path_of(map, context), options);
}

MadeParts read_grass(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "grass", {"path", "seed", "count", "clearance", "depth", "height_range"});
    GrassOptions options;
    map.read("seed", options.seed);
    map.read("count", options.count, {0, 200000});
    map.read("clearance", options.clearance, from_zero);
    map.read("depth", options.depth, from_zero);
    map.read("height_range", options.height_range, {0.01, 10});
    return make_grass(terrain_of(map, context), path_of(map, context), options);
}

PostOptions read_post_options(const YamlMap& map, double height) {
    PostOptions options;
    options.height = height;
    map.read("spacing", options.spacing, {1, 1e6});
    map.read("offset", options.offset, from_zero);
    map.read("height", options.height, {0.1, 50});
    if (const auto side = map.find("side")) options.side = side->choice({"left", "right", "both"});
    return options;
}

MadeParts read_posts(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "posts", {"path", "spacing", "offset", "height", "side"});
    return make_posts(path_of(map, context), read_post_options(map, 1));
}

MadeParts read_lamp_posts(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "lamp_posts", {"path", "spacing", "offset", "height", "side"});
    return make_lamp_posts(path_of(map, context), read_post_options(map, 7));
}

void read_colors(const YamlMap& map, std::vector<glm::vec3>& target) {
    const auto colors = map.find("colors");
    if (!colors) return;
    target.clear();
    for (const YamlValue& color : colors->list())
        target.push_back(color.color(1e6));
    if (target.empty()) colors->fail("expected at least one color");
}

MadeParts read_sparks(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "sparks",
                      {"seed", "count", "center", "radius", "height_range", "size_range", "colors"});
    SparkOptions options;
    map.read("seed", options.seed);
    map.read("count", options.count, {1, 20000});
    map.read("center", options.center, any_length);
    map.read("radius", options.radius, from_zero);
    map.read("height_range", options.height_range, any_length);
    map.read("size_range", options.size_range, positive);
    read_colors(map, options.colors);
    return make_sparks(context.library.terrain ? &*context.library.terrain : nullptr, options);
}

MadeParts read_twigs(const YamlValue& value, const Context&) {
    const YamlMap map(value, "twigs", {"seed", "count", "height", "spread", "thickness", "bud_range"});
    TwigOptions options;
    map.read("seed", options.seed);
    map.read("count", options.count, {1, 500});
    map.read("height", options.height, {0.01, 100});
    map.read("spread", options.spread, {0, 10});
    map.read("thickness", options.thickness, positive);
    map.read("bud_range", options.bud_range, positive);
    return make_twigs(options);
}

MadeParts read_light_string(const YamlValue& value, const Context& context) {
    const YamlMap map(value, "light_string", {"path", "seed", "spacing", "size", "wire", "colors"});
    LightStringOptions options;
    map.read("seed", options.seed);
    map.read("spacing", options.spacing, {0.001, 1e6});
    map.read("size", options.size, positive);
    map.read("wire", options.wire, positive);
    read_colors(map, options.colors);
    return make_light_string(path_of(map, context), options);
}

MadeParts read_car(const YamlValue& value, const Context&) {
    const YamlMap map(value, "car", {});
    return make_car();
}

struct Maker {
    std::string name;
    std::function<MadeParts(const YamlValue&, const Context&)> make;
};

const std::vector<Maker>& makers() {
    static const std::vector<Maker> all = {
        {"box", read_box},
        {"sphere", read_sphere},
        {"plane", read_plane},
        {"cylinder", read_cylinder},
        {"cone", read_cone},
        {"torus", read_torus},
        {"faces", read_faces},
        {"road", read_road},
        {"terrain", read_terrain_mesh},
        {"tree", read_tree},
        {"forest", read_forest},
        {"grass", read_grass},
        {"posts", read_posts},
        {"car", read_car},
        {"lamp_posts", read_lamp_posts},
        {"sparks", read_sparks},
        {"lathe", read_lathe},
        {"twigs", read_twigs},
        {"light_string", read_light_string},
    };
    return all;
}

/// The model of that file, read once.
const Model& find_model(const YamlValue& name, Scene& scene, Library& library) {
    const std::filesystem::path file = name.named_file("a model");
    const auto [known, added] = library.models.try_emplace(file.string());
    if (!added) return known->second;
    Model& model = known->second;
    model = library.read_model(file);
    for (const std::string& loss : model.losses)
        scene.losses.push_back(fmt::format("{}: {}", file.string(), loss));
    if (!model.lights.empty()) {
        scene.losses.push_back(
            fmt::format("{}: {} of its lights left out, for a scene file has its own", file.string(),
                        model.lights.size() == 1 ? "1 is" : fmt::format("{} are", model.lights.size())));
        model.lights.clear();
    }
    return model;
}

std::size_t slot_material(const std::string& slot, const YamlMap& slots, const YamlValue& mesh,
                          const Library& library) {
    if (const auto named = slots.find(slot)) return find_named(*named, library.materials, "material");
    if (const auto same = library.materials.find(slot); same != library.materials.end()) return same->second;
    mesh.fail(fmt::format("this needs a material for its \"{}\": define one of that name, or give the node "
                          "\"materials: {{{}: NAME}}\"",
                          slot, slot));
}

std::vector<Part> add_made(MadeParts made, const YamlValue& mesh, const std::optional<YamlValue>& material,
                           const std::optional<YamlValue>& slots, Scene& scene, Library& library) {
    std::vector<std::string> names;
    for (const MadePart& part : made)
        names.push_back(part.slot);
    if (slots && material) slots->fail("a node has \"material\" or \"materials\", not both");
    const YamlMap by_slot(slots.value_or(YamlValue(YAML::Node(), nullptr)), "materials", names);

    std::vector<Part> parts;
    for (MadePart& part : made) {
        if (part.mesh.empty()) continue;
        std::size_t index = 0;
        if (material) {
            index = find_named(*material, library.materials, "material");
        } else if (!part.slot.empty()) {
            index = slot_material(part.slot, by_slot, mesh, library);
        } else {
            index = scene.materials.size();
            scene.materials.push_back({});
        }
        parts.push_back({std::make_shared<const Mesh>(std::move(part.mesh)), index});
    }
    return parts;
}

} // namespace

std::vector<Part> read_mesh(const YamlValue& mesh, const std::optional<YamlValue>& material,
                            const std::optional<YamlValue>& slots, Scene& scene, Library& library) {
    std::vector<std::string> kinds{"model"};
    for (const Maker& maker : makers())
        kinds.push_back(maker.name);
    const auto entries = mesh.entries();
    if (entries.size() != 1) mesh.fail("expected one mesh, as in \"box: {size: [1, 1, 1]}\"");
    const auto& [kind, options] = entries.front();
    const std::string word = kind.choice(kinds);
    if (word == "model") return {}; // place_model does that
    for (const Maker& maker : makers()) {
        if (maker.name == word) {
            return add_made(maker.make(options, {scene, library}), mesh, material, slots, scene, library);
        }
    }
    return {};
}

void place_model(const YamlValue& mesh, const std::optional<YamlValue>& material, std::size_t node,
                 Scene& scene, Library& library) {
    const auto entries = mesh.entries();
    if (entries.front().first.text() != "model") return;
    const Model& model = find_model(entries.front().second, scene, library);
    const std::size_t first = scene.nodes.size(), first_material = scene.materials.size();
    add_model(scene, model, node);
    if (!material) return;
    scene.materials.resize(first_material);
    const std::size_t instead = find_named(*material, library.materials, "material");
    for (std::size_t i = first; i < scene.nodes.size(); ++i) {
        for (Part& part : scene.nodes[i].parts)
            part.material = instead;
    }
}

} // namespace postfx::host
