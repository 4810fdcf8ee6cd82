// The uniform blocks of shaders/scene/view.glsl and material.glsl, std140.
#pragma once

#include "scene.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace postfx::host {

struct LightBlock {
    glm::vec4 position, direction, color, attenuation;
};

struct ViewBlock {
    glm::mat4 offset_to_clip, world_to_view, clip_to_direction;
    glm::vec4 backward;
    glm::vec4 zenith, horizon, ground, disc_color, disc;
    glm::vec4 ambient_up, ambient_down;
    std::array<glm::vec4, max_shadows> shadow_texel;
    std::array<glm::mat4, max_shadows> offset_to_shadow;
    std::array<LightBlock, max_lights> lights;
};

inline constexpr std::size_t material_textures = 5;

struct MaterialBlock {
    glm::vec4 diffuse, specular, emission, factors;
    std::array<glm::vec4, 2 * material_textures> uv_rows;
    std::array<std::int32_t, 4> is;
};

} // namespace postfx::host
