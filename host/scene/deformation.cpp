#include "scene.hpp"

#include <algorithm>

namespace postfx::host {
namespace {

void add_shapes(const Deformation& deformation, const std::vector<float>& weights,
                std::vector<Vertex>& vertices) {
    const std::size_t count = std::min(weights.size(), deformation.shapes.size());
    for (std::size_t i = 0; i < count; ++i) {
        const Deformation::Shape& shape = deformation.shapes[i];
        if (weights[i] == 0) continue;
        for (std::size_t v = 0; v < shape.positions.size(); ++v)
            vertices[v].position += weights[i] * shape.positions[v];
        for (std::size_t v = 0; v < shape.normals.size(); ++v)
            vertices[v].normal += weights[i] * shape.normals[v];
    }
}

glm::vec3 unit_or(glm::vec3 vector, glm::vec3 otherwise) {
    const float length = glm::length(vector);
    return length > 0 ? vector / length : otherwise;
}

void move_with_joints(const Deformation& deformation, const std::vector<glm::mat4>& joints,
                      std::vector<Vertex>& vertices) {
    const std::size_t influences = deformation.influences;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        glm::mat4 placement(0);
        for (std::size_t i = v * influences; i < (v + 1) * influences; ++i) {
            if (deformation.weights[i] != 0)
                placement += deformation.weights[i] * joints[deformation.joints[i]];
        }
        vertices[v].position = glm::vec3(placement * glm::vec4(vertices[v].position, 1));
        vertices[v].normal = glm::mat3(normal_matrix(glm::dmat4(placement))) * vertices[v].normal;
    }
}

} // namespace

glm::dmat3 normal_matrix(const glm::dmat4& placement) {
    const glm::dvec3 x(placement[0]), y(placement[1]), z(placement[2]);
    glm::dmat3 result(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)); // the inverse's transpose, times
    double largest = 0;                                                      // the determinant
    for (int axis = 0; axis < 3; ++axis) {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(result[axis][row]));
    }
    if (glm::dot(x, result[0]) < 0) largest = -largest;
    return largest == 0 ? result : result / largest;
}

void deform(const Mesh& mesh, const std::vector<float>& weights, const std::vector<glm::mat4>& joints,
            std::vector<Vertex>& result) {
    result = mesh.vertices;
    if (!mesh.deformation) return;
    add_shapes(*mesh.deformation, weights, result);
    if (mesh.deformation->influences > 0 && !joints.empty())
        move_with_joints(*mesh.deformation, joints, result);
    for (std::size_t v = 0; v < result.size(); ++v)
        result[v].normal = unit_or(result[v].normal, mesh.vertices[v].normal);
}

std::vector<glm::mat4> Scene::joint_matrices(std::size_t node, const std::vector<glm::dmat4>& placed) const {
    std::vector<glm::mat4> joints;
    if (!nodes[node].skin) return joints;
    const Skin& skin = skins[*nodes[node].skin];
    const glm::dmat4 to_node = glm::inverse(placed[node]);
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        joints.emplace_back(to_node * placed[skin.joints[i]] * skin.mesh_to_joint[i]);
    return joints;
}

std::vector<float> Scene::shape_weights(std::size_t node, double time) const {
    const NodeKeys* keys = nodes[node].keys.get();
    if (!keys || !keys->shape_weights) return nodes[node].shape_weights;
    return keys->shape_weights->at(keys->looped(time));
}

void Scene::deform(std::size_t node, const Mesh& mesh, const std::vector<glm::dmat4>& placed, double time,
                   std::vector<Vertex>& result) const {
    host::deform(mesh, shape_weights(node, time), joint_matrices(node, placed), result);
}

std::shared_ptr<const Mesh> Scene::mesh_at(std::size_t node, const std::shared_ptr<const Mesh>& mesh,
                                           const std::vector<glm::dmat4>& placed, double time) const {
    if (!mesh->deformation) return mesh;
    auto result = std::make_shared<Mesh>();
    deform(node, *mesh, placed, time, result->vertices);
    result->indices = mesh->indices;
    return result;
}

} // namespace postfx::host
