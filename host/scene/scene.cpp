#include "scene.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// Reduced to one turn in double precision, so that weeks of time stay smooth.
double radians_at(const Animation::Turn& turn, double time) {
    return glm::radians(std::fmod(turn.degrees_per_second * time, 360.0));
}

glm::dmat4 animated(const Scene& scene, const Animation& animation, const glm::dmat4& local, double time) {
    glm::dmat4 result = local;
    if (animation.rotate) {
        result = glm::rotate(result, radians_at(*animation.rotate, time), animation.rotate->axis);
    }
    if (animation.orbit) {
        const Animation::Turn& orbit = *animation.orbit;
        const glm::dmat4 to_center = glm::translate(glm::dmat4(1), orbit.center);
        result = glm::rotate(to_center, radians_at(orbit, time), orbit.axis)
                 * glm::translate(glm::dmat4(1), -orbit.center) * result;
    }
    if (animation.follow) {
        const Animation::Follow& follow = *animation.follow;
        result = scene.paths[follow.path].frame(follow.start + follow.speed * time)
                 * glm::translate(glm::dmat4(1), {follow.side, follow.height, 0}) * result;
    }
    return result;
}

bool moves(const Animation& animation) {
    return animation.rotate || animation.orbit || animation.follow;
}

} // namespace

glm::dmat4 look_at_matrix(glm::dvec3 position, glm::dvec3 look_at, glm::dvec3 up) {
    const glm::dvec3 back = glm::normalize(position - look_at);
    glm::dvec3 right = glm::cross(up, back);
    if (glm::dot(right, right) < 1e-12) {
        right = glm::cross(std::abs(back.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1), back);
    }
    right = glm::normalize(right);
    return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
            glm::dvec4(position, 1)};
}

void Scene::place_nodes(double time, std::vector<glm::dmat4>& result) const {
    result.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i];
        const glm::dmat4 local =
            animated(*this, node.animation, node.keys ? node.keys->local(time) : node.local, time);
        result[i] = node.parent ? result[*node.parent] * local : local;
    }
}

Camera Scene::camera_at(double time, const std::vector<glm::dmat4>& placed) const {
    Camera result = camera.orthographic_extent
                        ? Camera::parallel(*camera.orthographic_extent, camera.near_plane, camera.far_plane)
                        : Camera::perspective(camera.vertical_fov, camera.near_plane);
    glm::dmat4 frame = animated(*this, camera.animation, glm::dmat4(1), time);
    if (camera.parent) frame = placed[*camera.parent] * frame;
    const auto to_world = [&](glm::dvec3 point, double w) {
        return glm::dvec3(frame * glm::dvec4(point, w));
    };
    const glm::dmat4 view_to_world =
        look_at_matrix(to_world(camera.position, 1), to_world(camera.look_at, 1), to_world(camera.up, 0));
    std::copy_n(glm::value_ptr(view_to_world), 16, result.view_to_world.begin());
    result.focus_distance = camera.focus_distance.value_or(0);
    return result;
}

Camera Scene::camera_at(double time) const {
    std::vector<glm::dmat4> placed;
    place_nodes(time, placed);
    return camera_at(time, placed);
}

Bounds Scene::bounds(double time) const {
    std::vector<glm::dmat4> placed;
    place_nodes(time, placed);
    Bounds result;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Part& part : nodes[i].parts) {
            result.add(mesh_at(i, part.mesh, placed, time)->bounds().transformed(placed[i]));
        }
    }
    return result;
}

SceneContents Scene::contents() const {
    const auto shines = [](glm::vec3 color) { return color != glm::vec3(0); };
    SceneContents contents;
    contents.lights = lights.size();
    contents.ambient = shines(surroundings.ambient_up) || shines(surroundings.ambient_down);
    contents.sky = shines(surroundings.zenith) || shines(surroundings.horizon) || shines(surroundings.ground)
                   || surroundings.stars > 0 || surroundings.disc.has_value();
    contents.moves = moves(camera.animation);
    for (const Node& node : nodes) {
        contents.moves = contents.moves || moves(node.animation) || node.keys;
        for (const Part& part : node.parts) {
            ++contents.parts;
            contents.triangles += part.mesh->indices.size() / 3;
            contents.emitters = contents.emitters || shines(materials[part.material].emission);
            contents.transparent = contents.transparent || materials[part.material].blended;
        }
    }
    return contents;
}

} // namespace postfx::host
