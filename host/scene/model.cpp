#include "model.hpp"

#include "assimp_model.hpp"
#include "gltf_document.hpp"
#include "gltf_reader.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace postfx::host {

std::size_t Model::part_count() const {
    std::size_t count = 0;
    for (const Node& node : nodes)
        count += node.parts.size();
    return count;
}

Model load_model(const std::filesystem::path& file, const ReadingHooks& hooks) {
    const Place place{file.string(), 0, 0, {}, {}};
    if (!std::filesystem::is_regular_file(file)) throw Error(place, "there is no such model file");
    std::optional<Model> model = is_gltf(file) ? read_gltf(file, hooks) : std::nullopt;
    if (!model) model = read_with_assimp(file, hooks);
    if (model->part_count() == 0) {
        const std::string why = fmt::format("{}", fmt::join(model->losses, "; "));
        throw Error(place, fmt::format("this model has no triangles{}{}", why.empty() ? "" : ": ", why));
    }
    return std::move(*model);
}

Model load_model_here(const std::filesystem::path& file) {
    return load_model(file);
}

void add_model(Scene& scene, const Model& model, std::optional<std::size_t> parent) {
    const std::size_t first_node = scene.nodes.size(), first_material = scene.materials.size(),
                      first_skin = scene.skins.size();
    scene.materials.insert(scene.materials.end(), model.materials.begin(), model.materials.end());
    for (Node node : model.nodes) {
        node.parent = node.parent ? first_node + *node.parent : parent;
        if (node.skin) *node.skin += first_skin;
        for (Part& part : node.parts)
            part.material += first_material;
        scene.nodes.push_back(std::move(node));
    }
    for (Skin skin : model.skins) {
        for (std::size_t& joint : skin.joints)
            joint += first_node;
        scene.skins.push_back(std::move(skin));
    }
    for (Light light : model.lights) {
        light.node += first_node;
        scene.lights.push_back(light);
    }
    for (NamedCamera camera : model.cameras) {
        if (camera.camera.parent) *camera.camera.parent += first_node;
        scene.cameras.push_back(std::move(camera));
    }
}

} // namespace postfx::host
