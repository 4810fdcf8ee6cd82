#include "assets.hpp"
#include "model_files.hpp"

#include <base/read_file.hpp>

#include <postfx/error.hpp>

#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace postfx::host {
namespace {

glm::mat4 to_glm(const aiMatrix4x4& m) {
    return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

glm::vec3 to_glm(const aiColor3D& c) {
    return {c.r, c.g, c.b};
}

/// Everything that is shared while one file is read.
class ModelReader {
public:
    ModelReader(const std::filesystem::path& file, const aiScene& scene) : file_(file), scene_(scene) {}

    Model read() {
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
            model_.materials.push_back(material(*scene_.mMaterials[i]));
        add_node(*scene_.mRootNode, glm::mat4(1));
        return std::move(model_);
    }

private:
    PicturePtr texture(const aiMaterial& material, std::initializer_list<aiTextureType> types, bool srgb) {
        aiString name;
        for (const aiTextureType type : types) {
            if (material.GetTexture(type, 0, &name) == aiReturn_SUCCESS) return picture(name.C_Str(), srgb);
        }
        return nullptr;
    }

    PicturePtr picture(const std::string& name, bool srgb) {
        PicturePtr& known = pictures_[{name, srgb}];
        if (known) return known;
        if (const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str())) {
            if (embedded->mHeight != 0) {
                throw Error({file_.string(), 0, 0, {}, {}},
                            fmt::format("embedded texture {} is not a PNG or JPEG", name));
            }
            known = decode_picture(reinterpret_cast<const std::uint8_t*>(embedded->pcData), embedded->mWidth,
                                   srgb, fmt::format("{} ({})", file_.string(), name));
        } else {
            std::string path = name; // files written on Windows
            std::replace(path.begin(), path.end(), '\\', '/');
            known = load_picture(folder_of(file_) / path, srgb);
        }
        return known;
    }

    Material material(const aiMaterial& source) {
        Material result;
        aiString name;
        if (source.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) result.name = name.C_Str();
        aiColor3D color;
        if (source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) result.diffuse = to_glm(color);
        if (source.Get(AI_MATKEY_COLOR_EMISSIVE, color) == aiReturn_SUCCESS) result.emission = to_glm(color);
        float number = 0;
        if (source.Get(AI_MATKEY_OPACITY, number) == aiReturn_SUCCESS) result.opacity = number;

        result.diffuse_texture = texture(source, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, true);
        result.emission_texture =
            texture(source, {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE}, true);
        result.normal_texture = texture(source, {aiTextureType_NORMALS}, false);
        if (source.Get(AI_MATKEY_METALLIC_FACTOR, number) == aiReturn_SUCCESS) {
            metal_roughness(source, number, result);
        } else {
            if (source.Get(AI_MATKEY_COLOR_SPECULAR, color) == aiReturn_SUCCESS)
                result.specular = to_glm(color);
            if (source.Get(AI_MATKEY_SHININESS, number) == aiReturn_SUCCESS && number > 0)
                result.shininess = number;
        }
        aiString alpha_mode;
        source.Get(AI_MATKEY_GLTF_ALPHAMODE, alpha_mode);
        const std::string mode = alpha_mode.C_Str();
        result.blended = mode == "BLEND" || result.opacity < 1;
        if (mode == "MASK") {
            result.alpha_cutoff = 0.5f;
            source.Get(AI_MATKEY_GLTF_ALPHACUTOFF, result.alpha_cutoff);
        }
        return result;
    }

    /// glTF's metal and roughness in terms of diffuse, specular and exponent. With a texture the shader does
    /// the same per pixel, from diffuse as base colour.
    void metal_roughness(const aiMaterial& source, float metalness, Material& result) {
        result.metal_roughness_texture =
            texture(source, {aiTextureType_METALNESS, aiTextureType_UNKNOWN}, false);
        if (result.metal_roughness_texture) return;
        float roughness = 1;
        source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness);
        result.specular = glm::mix(glm::vec3(0.04f), result.diffuse, metalness);
        result.diffuse *= 1 - metalness;
        const float alpha = std::max(roughness * roughness, 0.03f);
        result.shininess =
            std::max(2 / (alpha * alpha) - 2, 1.0f); // Walter et al. 2007, eq. 33's usual match
    }

    void add_node(const aiNode& node, const glm::mat4& parent) {
        const glm::mat4 to_model = parent * to_glm(node.mTransformation);
        for (unsigned i = 0; i < node.mNumMeshes; ++i)
            add_mesh(*scene_.mMeshes[node.mMeshes[i]], to_model);
        for (unsigned i = 0; i < node.mNumChildren; ++i)
            add_node(*node.mChildren[i], to_model);
    }

    void add_mesh(const aiMesh& source, const glm::mat4& to_model) {
        Mesh mesh;
        for (unsigned i = 0; i < source.mNumVertices; ++i) {
            const aiVector3D& p = source.mVertices[i];
            Vertex vertex{{p.x, p.y, p.z}};
            if (source.HasNormals())
                vertex.normal = {source.mNormals[i].x, source.mNormals[i].y, source.mNormals[i].z};
            if (source.HasTextureCoords(0))
                vertex.uv = {source.mTextureCoords[0][i].x, source.mTextureCoords[0][i].y};
            if (source.HasVertexColors(0)) {
                vertex.tint = {source.mColors[0][i].r, source.mColors[0][i].g, source.mColors[0][i].b};
            }
            const float length = glm::length(vertex.normal);
            vertex.normal = length > 0 ? vertex.normal / length : glm::vec3(0, 1, 0);
            mesh.add(vertex);
        }
        for (unsigned i = 0; i < source.mNumFaces; ++i) {
            const aiFace& face = source.mFaces[i];
            if (face.mNumIndices == 3) mesh.triangle(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
        }
        if (mesh.empty()) return; // points and lines
        auto placed = std::make_shared<Mesh>();
        placed->append(mesh, to_model);
        model_.parts.push_back({std::move(placed), source.mMaterialIndex});
    }

    const std::filesystem::path& file_;
    const aiScene& scene_;
    Model model_;
    std::map<std::pair<std::string, bool>, PicturePtr> pictures_;
};

} // namespace

Model load_model(const std::filesystem::path& file, const std::string& content) {
    const Place place{input_name(file), 0, 0, {}, {}};
    if (content.empty()) expect_readable(file, "a model");
    Assimp::Importer importer;
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 40); // sharper edges stay edges
    const aiScene* scene =
        read_by_content(importer, file, content,
                        aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices
                            | aiProcess_SortByPType | aiProcess_ImproveCacheLocality);
    if (!scene || !scene->mRootNode) {
        throw Error(place, fmt::format("can't read this model: {}", importer.GetErrorString()));
    }
    Model model = ModelReader(file, *scene).read();
    if (model.parts.empty()) throw Error(place, "this model has no triangles");
    return model;
}

bool is_model_file(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    return !ending.empty() && Assimp::Importer().IsExtensionSupported(ending);
}

} // namespace postfx::host
