#include "gltf_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

using Json = GltfDocument::Json;

constexpr double largest_power = 65504; ///< brightest that the targets hold

glm::vec3 color_of(const GltfDocument& document, const Json& object, const char* key, glm::vec3 otherwise) {
    const auto found = document.numbers(object, key, 3);
    return found ? glm::vec3((*found)[0], (*found)[1], (*found)[2]) : otherwise;
}

Sampler sampler_of(const GltfDocument& document, const Json& texture) {
    Sampler result;
    const auto index = document.find_index(texture, "sampler");
    if (!index) return result;
    const Json& source = document.item("samplers", *index);
    const auto wrap = [&](const char* key) {
        switch (document.find_index(source, key).value_or(10497)) {
        case 33071:
            return Sampler::Wrap::clamp;
        case 33648:
            return Sampler::Wrap::mirror;
        default:
            return Sampler::Wrap::repeat;
        }
    };
    result.wrap_u = wrap("wrapS");
    result.wrap_v = wrap("wrapT");
    constexpr std::size_t nearest = 9728, linear = 9729, first_with_mips = 9984;
    if (document.find_index(source, "magFilter") == nearest) result.magnify = Sampler::Filter::nearest;
    const std::size_t minify = document.find_index(source, "minFilter").value_or(9987);
    // 9984 to 9987: nearest and linear within a level, twice: for the nearest level and between levels.
    const bool mips = minify >= first_with_mips;
    if (minify == nearest || minify == linear) result.mips = Sampler::Mips::none;
    if (mips && minify < first_with_mips + 2) result.mips = Sampler::Mips::nearest;
    if (minify % 2 == 0) result.minify = Sampler::Filter::nearest;
    return result;
}

/// KHR_texture_transform, with v downwards, in terms of v upwards.
glm::mat3x2 placement_of(const GltfDocument& document, const Json& transform) {
    const auto pair = [&](const char* key, glm::vec2 otherwise) {
        const auto found = document.numbers(transform, key, 2);
        return found ? glm::vec2((*found)[0], (*found)[1]) : otherwise;
    };
    const glm::vec2 offset = pair("offset", {0, 0}), scale = pair("scale", {1, 1});
    const float angle = document.number(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    const glm::mat3 turned(c, -s, 0, s, c, 0, 0, 0, 1);
    const glm::mat3 scaled(scale.x, 0, 0, 0, scale.y, 0, 0, 0, 1),
        moved(1, 0, 0, 0, 1, 0, offset.x, offset.y, 1);
    const glm::mat3 flipped(1, 0, 0, 0, -1, 0, 0, 1, 1);
    return glm::mat3x2(flipped * moved * turned * scaled * flipped);
}

class MaterialReader {
public:
    MaterialReader(const GltfDocument& document, ModelPictures& pictures, Losses& losses)
        : document_(document), pictures_(pictures), losses_(losses) {}

    GltfMaterial read(const Json& source) {
        Material& material = result_.material;
        material.name = source.value("name", "");
        material.two_sided = source.value("doubleSided", false);
        material.metal_rough = true;
        material.diffuse = glm::vec3(1);
        if (const Json* glossy = GltfDocument::extension(source, "KHR_materials_pbrSpecularGlossiness")) {
            read_specular_glossiness(*glossy, material);
        } else {
            read_metal_roughness(source, material);
        }
        read_surface(source, material);
        read_emission(source, material);
        read_alpha(source, material);
        if (GltfDocument::extension(source, "KHR_materials_unlit")) keep_base_alone(material);
        return std::move(result_);
    }

private:
    /// KHR_materials_unlit: the base colour is what is seen.
    static void keep_base_alone(Material& material) {
        material.unlit = true;
        material.metal_rough = false;
        material.emission = glm::vec3(0);
        for (Texture* texture : {&material.emission_texture, &material.normal_texture,
                                 &material.metal_roughness_texture, &material.occlusion_texture})
            *texture = {};
    }

    void read_metal_roughness(const Json& source, Material& material) {
        static const Json none = Json::object();
        const auto found = source.find("pbrMetallicRoughness");
        const Json& pbr = found == source.end() ? none : *found;
        read_base(pbr, "baseColorFactor", "baseColorTexture", material);
        material.metalness = std::clamp(document_.number(pbr, "metallicFactor", 1), 0.0f, 1.0f);
        material.roughness = std::clamp(document_.number(pbr, "roughnessFactor", 1), 0.0f, 1.0f);
        material.metal_roughness_texture = texture(pbr, "metallicRoughnessTexture", false);
        float head_on = 0.04f;
        if (const Json* ior = GltfDocument::extension(source, "KHR_materials_ior")) {
            const float n = document_.number(*ior, "ior", 1.5f);
            head_on = n == 0 ? 1 : (n - 1) * (n - 1) / ((n + 1) * (n + 1)); // 0 stands for infinity
        }
        material.specular = glm::vec3(head_on);
        if (const Json* specular = GltfDocument::extension(source, "KHR_materials_specular")) {
            material.specular *= document_.number(*specular, "specularFactor", 1)
                                 * color_of(document_, *specular, "specularColorFactor", glm::vec3(1));
            material.specular = glm::min(material.specular, glm::vec3(1));
            lose_texture(*specular, "specularTexture");
            lose_texture(*specular, "specularColorTexture");
        }
    }

    void read_specular_glossiness(const Json& source, Material& material) {
        material.metal_rough = false;
        read_base(source, "diffuseFactor", "diffuseTexture", material);
        material.specular = color_of(document_, source, "specularFactor", glm::vec3(1));
        const float roughness = 1 - document_.number(source, "glossinessFactor", 1);
        const float alpha = std::max(roughness * roughness, 0.03f);
        material.shininess =
            std::max(2 / (alpha * alpha) - 2, 1.0f); // as the shader does for metal and roughness
        lose_texture(source, "specularGlossinessTexture");
    }

    void read_base(const Json& source, const char* factor, const char* map, Material& material) {
        if (const auto base = document_.numbers(source, factor, 4)) {
            material.diffuse = {(*base)[0], (*base)[1], (*base)[2]};
            material.opacity = (*base)[3];
        }
        material.diffuse_texture = texture(source, map, true);
    }

    void read_surface(const Json& source, Material& material) {
        material.normal_texture = texture(source, "normalTexture", false);
        material.occlusion_texture = texture(source, "occlusionTexture", false);
        if (material.normal_texture)
            material.normal_scale = document_.number(source.at("normalTexture"), "scale", 1);
        if (material.occlusion_texture) {
            material.occlusion_strength =
                std::clamp(document_.number(source.at("occlusionTexture"), "strength", 1), 0.0f, 1.0f);
        }
    }

    void read_emission(const Json& source, Material& material) {
        material.emission = color_of(document_, source, "emissiveFactor", glm::vec3(0));
        if (const Json* strength = GltfDocument::extension(source, "KHR_materials_emissive_strength"))
            material.emission *= document_.number(*strength, "emissiveStrength", 1);
        material.emission = glm::clamp(material.emission, 0.0f, static_cast<float>(largest_power));
        material.emission_texture = texture(source, "emissiveTexture", true);
    }

    void read_alpha(const Json& source, Material& material) {
        const std::string mode = source.value("alphaMode", "OPAQUE");
        material.blended = mode == "BLEND";
        if (mode == "MASK") material.alpha_cutoff = document_.number(source, "alphaCutoff", 0.5f);
        // OPAQUE has no use for alpha at all.
        if (mode != "BLEND" && mode != "MASK") material.opacity = 1;
    }

    Texture texture(const Json& owner, const char* key, bool srgb) {
        Texture result;
        const auto found = owner.find(key);
        if (found == owner.end()) return result;
        const Json& source = document_.item("textures", document_.index(*found, "index"));
        const auto image = image_of(source);
        if (!image) return result;
        result.picture = picture(*image, srgb);
        result.sampler = sampler_of(document_, source);
        std::size_t set = document_.find_index(*found, "texCoord").value_or(0);
        if (const Json* transform = GltfDocument::extension(*found, "KHR_texture_transform")) {
            result.placement = placement_of(document_, *transform);
            set = document_.find_index(*transform, "texCoord").value_or(set);
        }
        if (result.picture) result.uv_set = pick_uv_set(set, result_.uv_sets, result_.material.name, losses_);
        return result;
    }

    std::optional<std::size_t> image_of(const Json& texture) {
        if (const auto source = document_.find_index(texture, "source")) return source;
        if (const Json* webp = GltfDocument::extension(texture, "EXT_texture_webp"))
            return document_.find_index(*webp, "source");
        static const LossKind kind{"texture has no picture that postfx reads",
                                   "textures have no pictures that postfx reads"};
        losses_.add(kind, texture.value("name", ""));
        return std::nullopt;
    }

    PicturePtr picture(std::size_t image, bool srgb) {
        if (const auto bytes = document_.image_bytes(image))
            return pictures_.embedded(fmt::format("images[{}]", image), *bytes, srgb);
        return pictures_.file(document_.item("images", image).at("uri").get<std::string>(), srgb);
    }

    void lose_texture(const Json& owner, const char* key) {
        if (!owner.contains(key)) return;
        static const LossKind kind{"texture of the specular colour is left out",
                                   "textures of the specular colour are left out"};
        losses_.add(kind, result_.material.name);
    }

    const GltfDocument& document_;
    ModelPictures& pictures_;
    Losses& losses_;
    GltfMaterial result_;
};

} // namespace

GltfMaterial read_gltf_material(const GltfDocument& document, std::optional<std::size_t> index,
                                ModelPictures& pictures, Losses& losses) {
    static const Json none = Json::object();
    return MaterialReader(document, pictures, losses).read(index ? document.item("materials", *index) : none);
}

} // namespace postfx::host
