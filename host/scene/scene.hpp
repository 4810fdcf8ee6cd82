// A scene as data: what is where, how it shines and how it moves. No OpenGL.
#pragma once

#include "geometry.hpp"
#include "keyframes.hpp"
#include "material.hpp"
#include "path.hpp"

#include <postfx/camera.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

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
    std::shared_ptr<const NodeKeys>
        keys; ///< of a model's own animation; where there are any, they replace local
    std::vector<Part> parts;
    std::optional<std::size_t> skin;  ///< of the parts that have joints; index into Scene::skins
    std::vector<float> shape_weights; ///< of the parts' shapes, unless keys say otherwise
};

/// Which nodes move the vertices of a mesh.
struct Skin {
    std::vector<std::size_t> joints;       ///< nodes
    std::vector<glm::dmat4> mesh_to_joint; ///< for each joint, as the mesh was bound
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
    float range = 0;                ///< point and spot: metres beyond which there is none of it; 0: no end
    float inner_angle = 20;         ///< degrees from the axis: full light inside
    float outer_angle = 30;         ///< degrees from the axis: none outside
    bool casts_shadow = false;      ///< directional and spot
    float shadow_near = 0.05f;      ///< spot: metres; what is nearer throws no shadow
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

/// A camera that a model brings along.
struct NamedCamera {
    std::vector<std::string> names; ///< its own and that of its node, at least one
    SceneCamera camera;
};

struct SceneContents {
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
    std::vector<Skin> skins;
    std::vector<Light> lights;
    Surroundings surroundings;
    SceneCamera camera;
    double flying_speed = 4;          ///< metres per second, at which one gets about in it
    std::vector<NamedCamera> cameras; ///< others to choose from
    std::vector<std::string> losses;  ///< what of the files is not in the scene, a line for each kind

    /// Node to world for every node, `time` seconds after the start. Resizes `result`.
    void place_nodes(double time, std::vector<glm::dmat4>& result) const;
    /// The scene's camera at that time; `nodes` from place_nodes.
    Camera camera_at(double time, const std::vector<glm::dmat4>& nodes) const;
    /// The same, without having placed the nodes.
    Camera camera_at(double time) const;
    /// Of everything, at that time.
    Bounds bounds(double time = 0) const;
    /// What leads from a mesh of nodes[node] as it was bound to the node's space, for each joint; none without a skin.
    std::vector<glm::mat4> joint_matrices(std::size_t node, const std::vector<glm::dmat4>& placed) const;
    std::vector<float> shape_weights(std::size_t node, double time) const;
    /// Write the vertices of a mesh of nodes[node] as shapes and joints place them, in the node's space; `placed` from
    /// place_nodes at the same time.
    void deform(std::size_t node, const Mesh& mesh, const std::vector<glm::dmat4>& placed, double time,
                std::vector<Vertex>& result) const;
    /// The same as a mesh of its own; one without a deformation is returned as it is.
    std::shared_ptr<const Mesh> mesh_at(std::size_t node, const std::shared_ptr<const Mesh>& mesh,
                                        const std::vector<glm::dmat4>& placed, double time) const;
    SceneContents contents() const;
};

/// A matrix that looks from `position` towards `look_at` down its -z, to world. A view straight along `up` is
/// turned a little rather than undefined.
glm::dmat4 look_at_matrix(glm::dvec3 position, glm::dvec3 look_at, glm::dvec3 up);

/// A model as its file has it, before it stands in a scene.
struct Model {
    std::vector<Material> materials;
    std::vector<Node> nodes; ///< parents come first; parts, skins, lights and cameras count within the model
    std::vector<Skin> skins;
    std::vector<Light> lights;
    std::vector<NamedCamera> cameras;
    std::vector<std::string> losses; ///< what is not in the model, one line for each kind

    std::size_t part_count() const;
};

/// Where whoever opens a scene gets models from: load_model in model.hpp, or something that asks another process.
using ModelSource = std::function<Model(const std::filesystem::path&)>;
/// load_model, in this process.
Model load_model_here(const std::filesystem::path& file);

/// What the user means by SCENE: a name in `scenes_directory`, a scene file, a model file, which gets a camera and,
/// unless it has some, light of its own, or "-", either of them on standard input. Which of them a file is its content
/// says. Throws Error.
Scene open_scene(const std::string& argument, const std::filesystem::path& scenes_directory,
                 const ModelSource& read_model = load_model_here);

struct SceneEntry {
    std::string name, description;
    std::filesystem::path file;
};
/// The scenes of a directory, by name. A file that can't be read has that as its description.
std::vector<SceneEntry> list_scenes(const std::filesystem::path& scenes_directory);

/// Read a scene file. Throws Error with file:line:column, what was expected and the nearest name.
Scene read_scene(const std::filesystem::path& file, const ModelSource& read_model = load_model_here);
/// The same from text; `origin` names it in messages and anchors relative files.
Scene parse_scene(const std::string& yaml, const std::filesystem::path& origin,
                  const ModelSource& read_model = load_model_here);
/// A file's `description:` alone, without making anything.
std::string read_scene_description(const std::filesystem::path& file);

} // namespace postfx::host
