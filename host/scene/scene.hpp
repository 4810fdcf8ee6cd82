// A scene as data: what is where, how it shines and how it moves. No OpenGL.
#pragma once

#include "geometry.hpp"
#include "path.hpp"

#include <postfx/camera.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

/// 8-bit pixels of an image file, bottom row first.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    bool srgb = true; ///< colour; false for data (normals, roughness)
};
using PicturePtr = std::shared_ptr<const Picture>;

/// Normalised Blinn-Phong. Colours are linear Rec. 709.
struct Material {
    std::string name;
    glm::vec3 diffuse{0.8f};   ///< 0..1
    glm::vec3 specular{0.04f}; ///< 0..1, seen head-on
    float shininess = 32;      ///< Blinn-Phong exponent
    glm::vec3 emission{0};     ///< radiance, any value from 0 up
    float opacity = 1;         ///< below 1: blended, sorted back to front
    bool two_sided = true;
    float alpha_cutoff = 0; ///< fragments whose texture alpha is below are not there
    bool blended = false;   ///< opacity below 1, or a texture whose alpha means opacity
    PicturePtr diffuse_texture, normal_texture, emission_texture;
    PicturePtr metal_roughness_texture; ///< as in glTF: green is roughness, blue is metalness

    bool textured() const {
        return diffuse_texture || normal_texture || emission_texture || metal_roughness_texture;
    }
};

/// A drawable piece of a node: one mesh with one material.
struct Part {
    std::shared_ptr<const Mesh> mesh;
    std::size_t material = 0; ///< index into Scene::materials
};

/// Movement by time; what is not set does not happen. Angles in degrees, lengths in metres, time in seconds.
struct Animation {
    struct Turn {
        glm::dvec3 center{0}; ///< of the orbit, in the parent's space
        glm::dvec3 axis{0, 1, 0};
        double degrees_per_second = 0;
    };
    struct Follow {
        std::size_t path = 0; ///< index into Scene::paths
        double speed = 0;     ///< metres per second
        double start = 0;     ///< metres along the path at time 0
        double side = 0;      ///< metres to the right of the path
        double height = 0;    ///< metres above it
    };
    std::optional<Turn> rotate; ///< about the node's own origin
    std::optional<Turn> orbit;
    std::optional<Follow> follow;
};

struct Node {
    std::string name;
    std::optional<std::size_t> parent; ///< always an earlier node
    glm::dmat4 local{1};
    Animation animation;
    std::vector<Part> parts;
};

inline constexpr std::size_t max_lights = 16;
inline constexpr std::size_t max_shadows = 4; ///< lights of a scene that cast any

/// Shines along -z of its node. `color` is the radiance of a white diffuse surface that faces the light where
/// the attenuation is 1 (irradiance / pi).
struct Light {
    enum class Kind { directional, point, spot } kind = Kind::point;
    std::size_t node = 0;
    glm::vec3 color{1};
    glm::vec3 attenuation{1, 0, 0}; ///< x, y, z of 1 / (x + y L + z L^2), L in metres
    float inner_angle = 20;         ///< degrees from the axis: full light inside
    float outer_angle = 30;         ///< degrees from the axis: none outside
    bool casts_shadow = false;      ///< directional and spot
    float shadow_softness = 0.75f;  ///< half width of the shadow's filter, texels of its map
    /// Directional: metres around the middle of the view that shadows cover.
    float shadow_extent = 40;
};

/// What is seen where nothing is, and what lights everything a little.
struct Surroundings {
    glm::vec3 zenith{0}, horizon{0}, ground{0}; ///< radiance of the background
    float stars = 0;                            ///< radiance of the brightest ones
    struct Disc {                               ///< a sun or moon
        glm::vec3 direction{0, 1, 0};           ///< towards it, unit
        float angular_radius = 0.5f;            ///< degrees
        glm::vec3 color{0};
        float halo = 0; ///< radiance of the glow around it, as a share of color
    };
    std::optional<Disc> disc;
    glm::vec3 ambient_up{0}, ambient_down{0}; ///< light from above and from below, as Light::color
};

struct SceneCamera {
    std::optional<std::size_t> parent; ///< node whose space position and look_at are in
    Animation animation;
    glm::dvec3 position{0, 1, 5}, look_at{0}, up{0, 1, 0};
    double vertical_fov = 45;                  ///< degrees
    double near_plane = 0.1;                   ///< metres
    double far_plane = 1000;                   ///< metres, orthographic only
    std::optional<double> orthographic_extent; ///< metres that the picture's height spans
    std::optional<double> focus_distance;      ///< metres along the view axis; a default for whoever focuses
};

struct SceneFacts {
    std::size_t triangles = 0, parts = 0, lights = 0;
    bool emitters = false;    ///< some material emits light
    bool transparent = false; ///< some material is blended
    bool ambient = false;     ///< there is ambient light
    bool sky = false;         ///< the background is not black
    bool moves = false;       ///< something depends on time
};

struct Scene {
    std::string name, description;
    std::filesystem::path file;
    std::string content; ///< of a file that can't be read again, as it is a pipe; else ""
    std::vector<Material> materials;
    std::vector<Path> paths;
    std::vector<Node> nodes;
    std::vector<Light> lights;
    Surroundings surroundings;
    SceneCamera camera;

    /// Node to world for every node, `time` seconds after the start. Resizes `result`.
    void place_nodes(double time, std::vector<glm::dmat4>& result) const;
    /// The scene's camera at that time; `nodes` from place_nodes.
    Camera camera_at(double time, const std::vector<glm::dmat4>& nodes) const;
    /// The same, without having placed the nodes.
    Camera camera_at(double time) const;
    /// Of everything, at that time.
    Bounds bounds(double time = 0) const;
    SceneFacts facts() const;
};

/// A matrix that looks from `position` towards `look_at` down its -z, to world. A view straight along `up` is
/// turned a little rather than undefined.
glm::dmat4 look_at_matrix(glm::dvec3 position, glm::dvec3 look_at, glm::dvec3 up);

/// What the user means by SCENE: a name in `scenes_directory`, a scene file, a model file, which gets a camera and
/// light of its own, or "-", either of them on standard input. Which of them a file is its content says. Throws Error.
Scene open_scene(const std::string& argument, const std::filesystem::path& scenes_directory);

struct SceneEntry {
    std::string name, description;
    std::filesystem::path file;
};
/// The scenes of a directory, by name. A file that can't be read has that as its description.
std::vector<SceneEntry> list_scenes(const std::filesystem::path& scenes_directory);

/// Read a scene file. Throws Error with file:line:column, what was expected and the nearest name.
Scene read_scene(const std::filesystem::path& file);
/// The same from text; `origin` names it in messages and anchors relative files.
Scene parse_scene(const std::string& yaml, const std::filesystem::path& origin);
/// A file's `description:` alone, without making anything.
std::string read_scene_description(const std::filesystem::path& file);

} // namespace postfx::host
