#include "assimp_parts.hpp"
#include "mesh_checks.hpp"

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

glm::vec3 to_vec3(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

void read_extras(const aiMesh& source, const std::vector<std::size_t>& uv_sets, Mesh& mesh) {
    const bool second = uv_sets.size() > 1 && uv_sets[1] < AI_MAX_NUMBER_OF_TEXTURECOORDS
                        && source.HasTextureCoords(static_cast<unsigned>(uv_sets[1]));
    bool opacity = false;
    for (unsigned i = 0; i < source.mNumVertices && source.HasVertexColors(0); ++i)
        opacity = opacity || source.mColors[0][i].a != 1;
    if (!second && !opacity) return;
    mesh.extras.resize(source.mNumVertices);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        if (second) mesh.extras[i].uv = glm::vec2(to_vec3(source.mTextureCoords[uv_sets[1]][i]));
        if (opacity) mesh.extras[i].opacity = source.mColors[0][i].a;
    }
}

void read_shapes(const aiMesh& source, const Mesh& mesh, Deformation& deformation) {
    for (unsigned i = 0; i < source.mNumAnimMeshes; ++i) {
        const aiAnimMesh& target = *source.mAnimMeshes[i];
        Deformation::Shape shape;
        shape.positions.resize(source.mNumVertices);
        const bool fits = target.mNumVertices == source.mNumVertices;
        for (unsigned v = 0; v < source.mNumVertices && fits && target.HasPositions(); ++v)
            shape.positions[v] = to_vec3(target.mVertices[v]) - mesh.vertices[v].position;
        if (fits && target.HasNormals() && source.HasNormals()) {
            for (unsigned v = 0; v < source.mNumVertices; ++v)
                shape.normals.push_back(to_vec3(target.mNormals[v]) - mesh.vertices[v].normal);
        }
        deformation.shapes.push_back(std::move(shape));
    }
}

void read_bones(const aiMesh& source, Deformation& deformation) {
    std::vector<std::vector<std::pair<std::uint32_t, float>>> influences(source.mNumVertices);
    for (unsigned bone = 0; bone < source.mNumBones; ++bone) {
        for (unsigned i = 0; i < source.mBones[bone]->mNumWeights; ++i) {
            const aiVertexWeight& weight = source.mBones[bone]->mWeights[i];
            if (weight.mVertexId < source.mNumVertices && weight.mWeight > 0)
                influences[weight.mVertexId].emplace_back(bone, weight.mWeight);
        }
    }
    std::size_t most = 1;
    for (const auto& of_vertex : influences)
        most = std::max(most, of_vertex.size());
    deformation.influences = static_cast<std::uint32_t>(most);
    for (auto& of_vertex : influences) {
        float sum = 0;
        for (const auto& [bone, weight] : of_vertex)
            sum += weight;
        if (of_vertex.empty()) of_vertex.emplace_back(0, sum = 1);
        of_vertex.resize(most, {0, 0.0f});
        for (const auto& [bone, weight] : of_vertex) {
            deformation.joints.push_back(bone);
            deformation.weights.push_back(weight / sum);
        }
    }
}

/// Vertices that are not finite equal any other to assimp, which joins them; these equal none that is of use.
void mark_broken_vertices(aiMesh& mesh) {
    constexpr float nowhere = 4e18f; // beyond what drop_broken_triangles keeps, and its square is finite
    for (unsigned i = 0; i < mesh.mNumVertices && mesh.HasPositions(); ++i) {
        const aiVector3D& v = mesh.mVertices[i];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            mesh.mVertices[i] = aiVector3D(nowhere);
    }
}

bool has_direction(const aiVector3D& normal) {
    return normal.SquareLength() > 0 && std::isfinite(normal.SquareLength());
}

/// Normals without direction, as of STL files that leave them to the reader, are those of their faces; where there are no
/// others, assimp makes all of them.
void replace_broken_normals(aiMesh& mesh) {
    if (!mesh.mNormals || std::all_of(mesh.mNormals, mesh.mNormals + mesh.mNumVertices, has_direction))
        return;
    if (std::none_of(mesh.mNormals, mesh.mNormals + mesh.mNumVertices, has_direction)) {
        delete[] mesh.mNormals;
        mesh.mNormals = nullptr;
        return;
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const aiFace& face = mesh.mFaces[i];
        if (face.mNumIndices < 3) continue;
        const auto corner = [&](unsigned k) { return mesh.mVertices[face.mIndices[k]]; };
        const aiVector3D normal = (corner(1) - corner(0)) ^ (corner(2) - corner(0));
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            aiVector3D& of_vertex = mesh.mNormals[face.mIndices[k]];
            if (!has_direction(of_vertex)) of_vertex = normal;
        }
    }
}

} // namespace

void prepare_assimp_meshes(const aiScene& scene) {
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        mark_broken_vertices(*scene.mMeshes[i]);
        replace_broken_normals(*scene.mMeshes[i]);
    }
}

glm::dmat4 to_glm(const aiMatrix4x4& m) {
    return glm::dmat4(glm::mat4(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4,
                                m.b4, m.c4, m.d4));
}

Mesh read_assimp_mesh(const aiMesh& source, const std::vector<std::size_t>& uv_sets, Losses& losses) {
    Mesh mesh;
    const auto first_set = static_cast<unsigned>(uv_sets.empty() ? 0 : uv_sets[0]);
    const bool has_uv = first_set < AI_MAX_NUMBER_OF_TEXTURECOORDS && source.HasTextureCoords(first_set);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        Vertex vertex{to_vec3(source.mVertices[i])};
        if (source.HasNormals()) vertex.normal = to_vec3(source.mNormals[i]);
        if (has_uv) vertex.uv = glm::vec2(to_vec3(source.mTextureCoords[first_set][i]));
        if (source.HasVertexColors(0))
            vertex.tint = {source.mColors[0][i].r, source.mColors[0][i].g, source.mColors[0][i].b};
        mesh.add(vertex);
    }
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices == 3) mesh.triangle(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
    }
    read_extras(source, uv_sets, mesh);
    if (source.mNumAnimMeshes > 0 || source.mNumBones > 0) {
        auto deformation = std::make_shared<Deformation>();
        read_shapes(source, mesh, *deformation);
        if (source.mNumBones > 0) read_bones(source, *deformation);
        mesh.deformation = std::move(deformation);
    }
    drop_broken_triangles(mesh, source.mName.C_Str(), losses);
    return mesh;
}

} // namespace postfx::host
