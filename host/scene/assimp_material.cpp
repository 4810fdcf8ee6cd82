#include "assimp_parts.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>

namespace postfx::host {
namespace {

glm::vec3 to_glm(const aiColor3D& c) {
    return {c.r, c.g, c.b};
}

Sampler::Wrap wrap_of(aiTextureMapMode mode) {
    if (mode == aiTextureMapMode_Mirror) return Sampler::Wrap::mirror;
    return mode == aiTextureMapMode_Wrap ? Sampler::Wrap::repeat : Sampler::Wrap::clamp;
}

/// Where a material's texture of one kind is.
struct Source {
    std::string name;
    Sampler sampler;
    std::size_t uv_set = 0;
    glm::mat3x2 placement{glm::mat3(1)};
};

/// How an MTL file calls a picture of that type; "" where it has none.
const char* mtl_statement(aiTextureType type) {
    switch (type) {
    case aiTextureType_DIFFUSE:
        return "map_kd";
    case aiTextureType_EMISSIVE:
        return "map_ke";
    case aiTextureType_OPACITY:
        return "map_d";
    case aiTextureType_NORMALS:
        return "norm";
    default:
        return "";
    }
}

class MaterialReader {
public:
    MaterialReader(const aiScene& scene, const aiMaterial& source, const MtlPlacements& placements,
                   ModelPictures& pictures, Losses& losses)
        : scene_(scene), source_(source), placements_(placements), pictures_(pictures), losses_(losses) {}

    AssimpMaterial read() {
        Material& material = result_.material;
        aiString name;
        if (source_.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
        aiColor3D color;
        if (source_.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) material.diffuse = to_glm(color);
        if (source_.Get(AI_MATKEY_COLOR_EMISSIVE, color) == aiReturn_SUCCESS)
            material.emission = to_glm(color);
        source_.Get(AI_MATKEY_OPACITY, material.opacity);
        material.blended = material.opacity < 1;
        material.diffuse_texture = texture({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, true);
        material.emission_texture = texture({aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE}, true);
        material.normal_texture = texture({aiTextureType_NORMALS}, false);
        material.occlusion_texture = texture({aiTextureType_AMBIENT_OCCLUSION}, false);
        read_reflection(material);
        read_mask(material);
        count_unused();
        return std::move(result_);
    }

private:
    std::optional<Source> find(std::initializer_list<aiTextureType> types) const {
        for (const aiTextureType type : types) {
            aiString name;
            unsigned set = 0;
            aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
            if (source_.GetTexture(type, 0, &name, nullptr, &set, nullptr, nullptr, modes)
                != aiReturn_SUCCESS)
                continue;
            Source result{name.C_Str(), {}, set};
            const auto placed = placements_.find({result_.material.name, mtl_statement(type)});
            if (placed != placements_.end()) result.placement = placed->second;
            result.sampler.wrap_u = wrap_of(modes[0]);
            result.sampler.wrap_v = wrap_of(modes[1]);
            return result;
        }
        return std::nullopt;
    }

    Texture texture(std::initializer_list<aiTextureType> types, bool srgb) {
        Texture result;
        if (const auto source = find(types)) {
            result.picture = picture(source->name, srgb);
            result.sampler = source->sampler;
            result.placement = source->placement;
            if (result.picture)
                result.uv_set = pick_uv_set(source->uv_set, result_.uv_sets, result_.material.name, losses_);
        }
        return result;
    }

    PicturePtr picture(const std::string& name, bool srgb) {
        const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str());
        if (!embedded) return pictures_.file(name, srgb);
        if (embedded->mHeight != 0) {
            static const LossKind kind{"embedded texture is no picture file",
                                       "embedded textures are no picture files"};
            losses_.add(kind, name);
            return nullptr;
        }
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
        return pictures_.embedded(name, {bytes, bytes + embedded->mWidth}, srgb);
    }

    void read_reflection(Material& material) {
        const bool metal = source_.Get(AI_MATKEY_METALLIC_FACTOR, material.metalness) == aiReturn_SUCCESS;
        const bool rough = source_.Get(AI_MATKEY_ROUGHNESS_FACTOR, material.roughness) == aiReturn_SUCCESS;
        material.metal_rough = metal || rough;
        if (!metal) material.metalness = 0;
        if (material.metal_rough) return;
        aiColor3D color;
        float number = 0;
        // Without an exponent the colour is assimp's own, as of STL and PLY, where it is white.
        if (source_.Get(AI_MATKEY_SHININESS, number) != aiReturn_SUCCESS) return;
        if (number > 0) material.shininess = number;
        if (source_.Get(AI_MATKEY_COLOR_SPECULAR, color) == aiReturn_SUCCESS)
            material.specular = to_glm(color);
    }

    /// A picture of opacity alone, as OBJ's map_d.
    void read_mask(Material& material) {
        const auto mask = find({aiTextureType_OPACITY});
        if (!mask || scene_.GetEmbeddedTexture(mask->name.c_str())) return;
        const auto color = find({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
        const bool separate = color && scene_.GetEmbeddedTexture(color->name.c_str());
        const ModelPictures::Masked masked =
            pictures_.masked(color && !separate ? color->name : "", mask->name);
        if (!masked.picture) return;
        material.diffuse_texture.picture = masked.picture;
        if (!color) {
            material.diffuse_texture.sampler = mask->sampler;
            material.diffuse_texture.placement = mask->placement;
            material.diffuse_texture.uv_set =
                pick_uv_set(mask->uv_set, result_.uv_sets, result_.material.name, losses_);
        }
        if (masked.cuts && !material.blended) {
            material.alpha_cutoff = 0.5f;
        } else {
            material.blended = true;
        }
    }

    void count_unused() {
        static const LossKind kind{"texture is of a use that postfx doesn't have",
                                   "textures are of uses that postfx doesn't have"};
        const auto color = find({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
        for (const aiTextureType type :
             {aiTextureType_SPECULAR, aiTextureType_AMBIENT, aiTextureType_HEIGHT, aiTextureType_SHININESS,
              aiTextureType_DISPLACEMENT, aiTextureType_LIGHTMAP, aiTextureType_REFLECTION,
              aiTextureType_METALNESS, aiTextureType_DIFFUSE_ROUGHNESS}) {
            const auto unused = find({type});
            if (unused && !(color && color->name == unused->name))
                losses_.add(kind, fmt::format("{}: {}", aiTextureTypeToString(type), unused->name));
        }
    }

    const aiScene& scene_;
    const aiMaterial& source_;
    const MtlPlacements& placements_;
    ModelPictures& pictures_;
    Losses& losses_;
    AssimpMaterial result_;
};

} // namespace

AssimpMaterial read_assimp_material(const aiScene& scene, const aiMaterial& source,
                                    const MtlPlacements& placements, ModelPictures& pictures,
                                    Losses& losses) {
    return MaterialReader(scene, source, placements, pictures, losses).read();
}

} // namespace postfx::host
