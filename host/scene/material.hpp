// What surfaces are made of. No OpenGL.
#pragma once

#include <glm/glm.hpp>

#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace postfx::host {

/// 8-bit pixels of an image file, bottom row first.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    bool srgb = true; ///< colour; false for data (normals, roughness)
};
using PicturePtr = std::shared_ptr<const Picture>;

/// How a picture is read between its pixels and outside of itself.
struct Sampler {
    enum class Wrap : std::uint8_t { repeat, clamp, mirror };
    enum class Filter : std::uint8_t { nearest, linear };
    enum class Mips : std::uint8_t { none, nearest, linear };
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Filter magnify = Filter::linear, minify = Filter::linear;
    Mips mips = Mips::linear;

    auto operator<=>(const Sampler&) const = default;
};

/// A picture on a surface.
struct Texture {
    PicturePtr picture; ///< null: there is none, which counts as white
    Sampler sampler;
    std::uint32_t uv_set = 0;            ///< 0 or 1: Vertex::uv or VertexExtra::uv
    glm::mat3x2 placement{glm::mat3(1)}; ///< (u, v, 1) of the vertices to those of the picture, v upwards

    Texture() = default;
    Texture(PicturePtr given) : picture(std::move(given)) {}
    explicit operator bool() const { return picture != nullptr; }
    const Picture* operator->() const { return picture.get(); }
    /// Is it read anywhere else than at the vertices' first (u, v)?
    bool is_placed() const { return uv_set != 0 || placement != glm::mat3x2(glm::mat3(1)); }
};

/// Normalised Blinn-Phong. Colours are linear Rec. 709.
struct Material {
    std::string name;
    glm::vec3 diffuse{0.8f};   ///< 0..1
    glm::vec3 specular{0.04f}; ///< 0..1, seen head-on
    float shininess = 32;      ///< Blinn-Phong exponent
    glm::vec3 emission{0};     ///< radiance, any value from 0 up
    float opacity = 1;         ///< blended: below 1 shows what is behind
    bool two_sided = true;
    float alpha_cutoff = 0; ///< fragments whose alpha is below are not there; 0 cuts nothing
    bool blended = false;   ///< alpha is opacity, and parts are sorted back to front
    bool unlit = false;     ///< diffuse is what is seen, whatever light there is

    /// As in glTF: diffuse is the base colour, specular that of what is no metal, and the exponent comes from the
    /// roughness. A vertex's tint is of the base colour alone.
    bool metal_rough = false;
    float metalness = 1, roughness = 1; ///< 0..1, times blue and green of metal_roughness_texture

    float normal_scale = 1;       ///< of the normal texture's x and y
    float occlusion_strength = 1; ///< 0..1: share of the occlusion texture's red in ambient light

    Texture diffuse_texture, emission_texture, normal_texture, metal_roughness_texture, occlusion_texture;

    bool textured() const {
        return diffuse_texture || emission_texture || normal_texture || metal_roughness_texture
               || occlusion_texture;
    }
};

} // namespace postfx::host
