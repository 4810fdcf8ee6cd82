// Nodes, skins, lights and cameras of glTF, and the whole of it.
#include "gltf_reader.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace postfx::host {
namespace {

using Json = GltfDocument::Json;

constexpr std::size_t none = ~std::size_t{0};

glm::dmat4 matrix_of(const std::vector<float>& values, std::size_t first = 0) {
    glm::dmat4 result(1);
    for (std::size_t i = 0; i < 16; ++i)
        result[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = static_cast<double>(values[first + i]);
    return result;
}

class GltfReader {
public:
    GltfReader(const std::filesystem::path& file, const ReadingHooks& hooks)
        : document_(file, hooks, losses_), pictures_(file, hooks, losses_) {}

    std::optional<Model> read() {
        if (document_.version() == 1) return std::nullopt;
        order_nodes();
        mark_scene();
        for (const std::size_t node : order_)
            add_node(node);
        for (std::size_t i = 0; i < document_.count("skins"); ++i)
            model_.skins.push_back(read_skin(document_.item("skins", i)));
        check_joints();
        play_clips(read_gltf_animations(document_, place_of_, model_.nodes), at_rest_, model_.nodes, losses_);
        model_.losses = losses_.lines();
        return std::move(model_);
    }

private:
    std::vector<std::size_t> children_of(std::size_t node) const {
        std::vector<std::size_t> result;
        const Json& source = document_.item("nodes", node);
        const auto children = source.find("children");
        if (children == source.end()) return result;
        for (const Json& child : *children) {
            if (!child.is_number_unsigned()) document_.fail("a node's children are no list of numbers");
            document_.item("nodes", child.get<std::size_t>());
            result.push_back(child.get<std::size_t>());
        }
        return result;
    }

    /// Parents before children. glTF's nodes are trees: with a node in two places there could be 2^n of them.
    void order_nodes() {
        const std::size_t count = document_.count("nodes");
        parent_.assign(count, none);
        for (std::size_t node = 0; node < count; ++node) {
            for (const std::size_t child : children_of(node)) {
                if (parent_[child] != none)
                    document_.fail(fmt::format("nodes[{}] has two parents, expected a tree", child));
                parent_[child] = node;
            }
        }
        for (std::size_t node = 0; node < count; ++node) {
            if (parent_[node] == none) order_.push_back(node);
        }
        for (std::size_t i = 0; i < order_.size(); ++i) {
            for (const std::size_t child : children_of(order_[i]))
                order_.push_back(child);
        }
        if (order_.size() < count) document_.fail("a node is its own ancestor, expected a tree");
        place_of_.assign(count, 0);
        for (std::size_t i = 0; i < order_.size(); ++i)
            place_of_[order_[i]] = i;
    }

    /// Which nodes are of the scene that the file shows; without any scene all are.
    void mark_scene() {
        const std::size_t scenes = document_.count("scenes");
        shown_.assign(order_.size(), scenes == 0);
        if (scenes == 0) return;
        static const LossKind kind{"other scene of the file is left out",
                                   "other scenes of the file are left out"};
        const Json& scene =
            document_.item("scenes", document_.find_index(document_.json(), "scene").value_or(0));
        losses_.add(kind, "", scenes - 1);
        if (const auto roots = scene.find("nodes"); roots != scene.end()) {
            for (const Json& root : *roots) {
                if (!root.is_number_unsigned()) document_.fail("a scene's nodes are no list of numbers");
                document_.item("nodes", root.get<std::size_t>());
                shown_[root.get<std::size_t>()] = true;
            }
        }
        for (const std::size_t node : order_) {
            if (parent_[node] != none && shown_[parent_[node]]) shown_[node] = true;
        }
    }

    void add_node(std::size_t index) {
        const Json& source = document_.item("nodes", index);
        Node node;
        node.name = source.value("name", "");
        if (parent_[index] != none) node.parent = place_of_[parent_[index]];
        at_rest_.push_back(read_placement(source, node.local));
        if (const auto mesh = document_.find_index(source, "mesh"); mesh && shown_[index])
            add_mesh(source, *mesh, node);
        if (shown_[index]) add_light_and_camera(source, node.name);
        model_.nodes.push_back(std::move(node));
    }

    NodeKeys read_placement(const Json& source, glm::dmat4& local) const {
        if (const auto matrix = document_.numbers(source, "matrix", 16)) {
            local = matrix_of(*matrix);
            return keys_at_rest(local);
        }
        NodeKeys keys;
        const auto vector = [&](const char* key, glm::dvec3& target) {
            if (const auto v = document_.numbers(source, key, 3)) target = {(*v)[0], (*v)[1], (*v)[2]};
        };
        vector("translation", keys.translation);
        vector("scale", keys.scale);
        if (const auto q = document_.numbers(source, "rotation", 4)) {
            const glm::dquat turn(static_cast<double>((*q)[3]), static_cast<double>((*q)[0]),
                                  static_cast<double>((*q)[1]), static_cast<double>((*q)[2]));
            if (glm::length(turn) > 0) keys.rotation = glm::normalize(turn);
        }
        local = keys.local(0);
        return keys;
    }

    void add_mesh(const Json& source, std::size_t mesh, Node& node) {
        node.parts = parts_of(mesh);
        node.skin = document_.find_index(source, "skin");
        if (node.skin) document_.item("skins", *node.skin);
        std::size_t shapes = 0;
        for (const Part& part : node.parts) {
            if (part.mesh->deformation) shapes = std::max(shapes, part.mesh->deformation->shapes.size());
        }
        if (shapes == 0) return;
        auto weights = document_.numbers(source, "weights", shapes);
        if (!weights) weights = document_.numbers(document_.item("meshes", mesh), "weights", shapes);
        node.shape_weights = weights.value_or(std::vector<float>(shapes, 0.0f));
    }

    const std::vector<Part>& parts_of(std::size_t mesh) {
        const auto [known, added] = parts_.try_emplace(mesh);
        if (!added) return known->second;
        const Json& source = document_.item("meshes", mesh);
        if (!source.contains("primitives")) document_.fail(fmt::format("meshes[{}] has no primitives", mesh));
        for (const Json& primitive : source.at("primitives")) {
            const std::size_t material = material_of(document_.find_index(primitive, "material"));
            Mesh made = read_gltf_primitive(document_, primitive, uv_sets_[material], losses_);
            if (!made.empty())
                known->second.push_back({std::make_shared<const Mesh>(std::move(made)), material});
        }
        return known->second;
    }

    /// As an index into the model's.
    std::size_t material_of(std::optional<std::size_t> index) {
        const auto [known, added] = materials_.try_emplace(index, model_.materials.size());
        if (!added) return known->second;
        GltfMaterial material = read_gltf_material(document_, index, pictures_, losses_);
        model_.materials.push_back(std::move(material.material));
        uv_sets_.push_back(material.uv_sets);
        return known->second;
    }

    void add_light_and_camera(const Json& source, const std::string& name) {
        const std::size_t node = model_.nodes.size();
        if (const Json* punctual = GltfDocument::extension(source, "KHR_lights_punctual")) {
            if (auto light = read_gltf_light(document_, document_.index(*punctual, "light"), losses_)) {
                light->node = node;
                model_.lights.push_back(*light);
            }
        }
        if (const auto index = document_.find_index(source, "camera")) {
            NamedCamera camera = read_gltf_camera(document_, *index);
            camera.camera.parent = node;
            if (!name.empty()) camera.names.push_back(name);
            if (camera.names.empty()) camera.names.push_back(fmt::format("camera {}", *index));
            model_.cameras.push_back(std::move(camera));
        }
    }

    Skin read_skin(const Json& source) const {
        Skin skin;
        if (!source.contains("joints")) document_.fail("a skin has no joints");
        for (const Json& joint : source.at("joints")) {
            if (!joint.is_number_unsigned()) document_.fail("a skin's joints are no list of numbers");
            document_.item("nodes", joint.get<std::size_t>());
            skin.joints.push_back(place_of_[joint.get<std::size_t>()]);
        }
        skin.mesh_to_joint.assign(skin.joints.size(), glm::dmat4(1));
        if (const auto matrices = document_.find_index(source, "inverseBindMatrices")) {
            const std::vector<float> values = read_numbers(document_, *matrices, 16);
            if (values.size() < 16 * skin.joints.size())
                document_.fail("a skin has fewer matrices than joints");
            for (std::size_t i = 0; i < skin.joints.size(); ++i)
                skin.mesh_to_joint[i] = matrix_of(values, 16 * i);
        }
        return skin;
    }

    void check_joints() const {
        for (const Node& node : model_.nodes) {
            if (!node.skin) continue;
            const std::size_t joints = model_.skins[*node.skin].joints.size();
            for (const Part& part : node.parts) {
                if (!part.mesh->deformation) continue;
                for (const std::uint32_t joint : part.mesh->deformation->joints) {
                    if (joint >= joints)
                        document_.fail(fmt::format("a vertex has the joint {}, and its skin has {} joints",
                                                   joint, joints));
                }
            }
        }
    }

    Losses losses_;
    GltfDocument document_;
    ModelPictures pictures_;
    Model model_;
    std::vector<std::size_t> parent_, order_, place_of_; ///< of glTF's nodes; place_of_ in the model
    std::vector<bool> shown_;
    std::vector<NodeKeys> at_rest_; ///< of the model's nodes
    std::map<std::size_t, std::vector<Part>> parts_;
    std::map<std::optional<std::size_t>, std::size_t> materials_;
    std::vector<std::vector<std::size_t>> uv_sets_; ///< of the model's materials
};

} // namespace

std::optional<Light> read_gltf_light(const GltfDocument& document, std::size_t index, Losses& losses) {
    const Json* extension = GltfDocument::extension(document.json(), "KHR_lights_punctual");
    if (!extension || !extension->contains("lights") || index >= extension->at("lights").size())
        document.fail(fmt::format("a node has the light {}, which is not there", index));
    const Json& source = extension->at("lights")[index];
    const std::string type = source.value("type", "");
    Light light;
    light.attenuation = {0, 0, 1};
    if (type == "directional") {
        light.kind = Light::Kind::directional;
    } else if (type == "spot") {
        light.kind = Light::Kind::spot;
        static const Json defaults = Json::object();
        const auto found = source.find("spot");
        const Json& spot = found == source.end() ? defaults : *found;
        light.inner_angle = glm::degrees(document.number(spot, "innerConeAngle", 0));
        light.outer_angle = glm::degrees(document.number(spot, "outerConeAngle", glm::radians(45.0f)));
    } else if (type != "point") {
        static const LossKind kind{"light is of a kind that postfx doesn't know",
                                   "lights are of kinds that postfx doesn't know"};
        losses.add(kind, type);
        return std::nullopt;
    }
    // Lux and candela: irradiance, of which a white surface gives back 1 / pi.
    light.color = glm::vec3(document.number(source, "intensity", 1) / glm::radians(180.0f));
    if (const auto color = document.numbers(source, "color", 3))
        light.color *= glm::vec3((*color)[0], (*color)[1], (*color)[2]);
    if (light.kind != Light::Kind::directional) light.range = document.number(source, "range", 0);
    return light;
}

NamedCamera read_gltf_camera(const GltfDocument& document, std::size_t index) {
    const Json& source = document.item("cameras", index);
    NamedCamera result;
    if (const std::string name = source.value("name", ""); !name.empty()) result.names.push_back(name);
    SceneCamera& camera = result.camera;
    camera.position = glm::dvec3(0);
    camera.look_at = {0, 0, -1};
    const std::string type = source.value("type", "");
    if (type != "perspective" && type != "orthographic")
        document.fail(
            fmt::format("cameras[{}] is \"{}\", expected \"perspective\" or \"orthographic\"", index, type));
    if (!source.contains(type)) document.fail(fmt::format("cameras[{}] has no \"{}\"", index, type));
    const Json& lens = source.at(type);
    camera.near_plane = static_cast<double>(document.number(lens, "znear", 0.1f));
    if (type == "perspective") {
        camera.vertical_fov = glm::degrees(static_cast<double>(document.number(lens, "yfov", 0.8f)));
        if (!(camera.near_plane > 0) || !(camera.vertical_fov > 0 && camera.vertical_fov < 180))
            document.fail(fmt::format("cameras[{}] has no usable yfov and znear", index));
    } else {
        camera.orthographic_extent = 2 * std::abs(static_cast<double>(document.number(lens, "ymag", 1)));
        camera.far_plane = static_cast<double>(document.number(lens, "zfar", 1000));
        if (*camera.orthographic_extent == 0 || camera.far_plane <= camera.near_plane)
            document.fail(fmt::format("cameras[{}] has no usable ymag, znear and zfar", index));
    }
    return result;
}

std::optional<Model> read_gltf(const std::filesystem::path& file, const ReadingHooks& hooks) {
    try {
        return GltfReader(file, hooks).read();
    } catch (const Json::exception& error) {
        throw Error({file.string(), 0, 0, {}, {}}, fmt::format("this is no glTF 2.0: {}", error.what()));
    }
}

} // namespace postfx::host
