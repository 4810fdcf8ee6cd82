#include <execute/frame_checks.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace postfx {
namespace {

std::string_view kind_name(GLenum target) {
    switch (target) {
    case GL_TEXTURE_1D:
        return "a 1D texture";
    case GL_TEXTURE_3D:
        return "a 3D texture";
    case GL_TEXTURE_1D_ARRAY:
    case GL_TEXTURE_2D_ARRAY:
        return "an array texture";
    case GL_TEXTURE_CUBE_MAP:
    case GL_TEXTURE_CUBE_MAP_ARRAY:
        return "a cube map";
    case GL_TEXTURE_RECTANGLE:
        return "a rectangle texture";
    case GL_TEXTURE_BUFFER:
        return "a buffer texture";
    case GL_TEXTURE_2D_MULTISAMPLE:
    case GL_TEXTURE_2D_MULTISAMPLE_ARRAY:
        return "a multisample texture (resolve it first)";
    default:
        return "a texture of another kind";
    }
}

GLint parameter(GLuint texture, GLenum name) {
    GLint value = 0;
    glGetTextureParameteriv(texture, name, &value);
    return value;
}

bool holds_integers(GLuint texture, GLint level) {
    GLint color = GL_NONE, depth = GL_NONE;
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_RED_TYPE, &color);
    if (color != GL_NONE) return color == GL_INT || color == GL_UNSIGNED_INT;
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_DEPTH_TYPE, &depth);
    return depth == GL_NONE || parameter(texture, GL_DEPTH_STENCIL_TEXTURE_MODE) == GL_STENCIL_INDEX;
}

/// "" if the plan can read it.
std::string problem_of(GLuint texture, int width, int height) {
    if (texture == 0) return "there is no texture: its name is 0";
    if (!glIsTexture(texture)) return fmt::format("{} is no texture of this context", texture);
    const auto target = static_cast<GLenum>(parameter(texture, GL_TEXTURE_TARGET));
    if (target != GL_TEXTURE_2D)
        return fmt::format("texture {} is {}; a 2D texture is expected", texture, kind_name(target));
    const GLint level = parameter(texture, GL_TEXTURE_BASE_LEVEL);
    GLint size[2] = {};
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_WIDTH, &size[0]);
    glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_HEIGHT, &size[1]);
    if (size[0] != width || size[1] != height) {
        return fmt::format("texture {} has {}x{} pixels, the plan is for {}x{}", texture, size[0], size[1],
                           width, height);
    }
    if (holds_integers(texture, level))
        return fmt::format("texture {} holds integers; numbers that can be filtered are expected", texture);
    return "";
}

void expect(bool right, std::string_view member, double value, std::string_view expected) {
    if (!right) throw Error(fmt::format("FrameInputs::{} is {}; expected {}", member, value, expected));
}

} // namespace

void check_textures(const Plan& plan, const std::vector<std::uint32_t>& textures,
                    const std::function<bool(std::uint32_t)>& is_own) {
    if (textures.size() != plan.attachments.size()) {
        throw Error(fmt::format("the plan reads {} attachments ({}), {} were given", plan.attachments.size(),
                                fmt::join(plan.attachments, ", "), textures.size()));
    }
    for (std::size_t i = 0; i < textures.size(); ++i) {
        std::string problem = problem_of(textures[i], plan.width, plan.height);
        if (problem.empty() && is_own(textures[i])) {
            problem =
                fmt::format("texture {} is the executor's own, which this frame is drawn into; copy it first",
                            textures[i]);
        }
        if (!problem.empty())
            throw Error(fmt::format("attachment {} of \"{}\": {}", i, plan.attachments[i], problem));
    }
}

void check_camera(const Camera& camera) {
    const auto finite = [](std::string_view member, double value) {
        expect(std::isfinite(value), member, value, "a number");
    };
    if (camera.orthographic) {
        expect(camera.vertical_extent > 0 && std::isfinite(camera.vertical_extent), "camera.vertical_extent",
               camera.vertical_extent, "metres above 0");
    } else {
        expect(camera.vertical_fov > 0 && camera.vertical_fov < 180, "camera.vertical_fov",
               camera.vertical_fov, "degrees between 0 and 180");
    }
    finite("camera.principal_point[0]", camera.principal_point[0]);
    finite("camera.principal_point[1]", camera.principal_point[1]);
    finite("camera.near_plane", camera.near_plane);
    expect(!std::isnan(camera.far_plane), "camera.far_plane", camera.far_plane, "a number, or infinity");
    finite("camera.depth_scale", camera.depth_scale);
    finite("camera.depth_offset", camera.depth_offset);
    finite("camera.sky_depth", camera.sky_depth);
    finite("camera.focus_distance", camera.focus_distance);
    for (double number : camera.view_to_world)
        finite("camera.view_to_world", number);
}

void check_time(double time) {
    expect(std::isfinite(time), "time", time, "seconds");
}

} // namespace postfx
