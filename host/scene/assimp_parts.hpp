// What assimp delivers, as parts of a model.
#pragma once

#include "animation_clips.hpp"
#include "model_pictures.hpp"
#include "obj_text.hpp"

#include <assimp/scene.h>

#include <map>
#include <string>
#include <vector>

namespace postfx::host {

glm::dmat4 to_glm(const aiMatrix4x4& matrix);

/// A material with the numbers of the UV channels that it calls 0 and 1.
struct AssimpMaterial {
    Material material;
    std::vector<std::size_t> uv_sets;
};
/// `placements` of an OBJ's pictures; none of other formats.
AssimpMaterial read_assimp_material(const aiScene& scene, const aiMaterial& source,
                                    const MtlPlacements& placements, ModelPictures& pictures, Losses& losses);
/// Make meshes fit for assimp's own processing: what is not finite must not be joined with what is.
void prepare_assimp_meshes(const aiScene& scene);
/// The triangles; the joints of vertices are the mesh's bones in their order.
Mesh read_assimp_mesh(const aiMesh& source, const std::vector<std::size_t>& uv_sets, Losses& losses);
AnimationClip read_assimp_animation(const aiAnimation& source,
                                    const std::map<std::string, std::size_t>& node_by_name,
                                    const std::vector<Node>& nodes);

} // namespace postfx::host
