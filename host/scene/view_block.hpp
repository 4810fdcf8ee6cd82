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
    glm::mat4 world_to_clip, world_to_view, clip_to_direction;
    glm::vec4 eye, backward;
    glm::vec4 zenith, horizon, ground, disc_color, disc;
    glm::vec4 ambient_up, ambient_down;
    std::array<glm::vec4, max_shadows> shadow_texel;
    std::array<glm::mat4, max_shadows> world_to_shadow;
    std::array<LightBlock, max_lights> lights;
};

struct MaterialBlock {
    glm::vec4 diffuse, specular, emission;
    std::array<std::int32_t, 4> has_maps;
};

} // namespace postfx::host
