#include "moving_bounds.hpp"

#include <algorithm>

namespace postfx::host {
namespace {

/// Sums of float32 in deform(): some roundings of 2^-24 of the largest coordinate.
constexpr double deform_error = 1e-6;

} // namespace

MovingBounds::MovingBounds(const Mesh& mesh) {
    const Deformation& deformation = *mesh.deformation;
    const std::size_t shapes = deformation.shapes.size();
    all_.shapes.resize(shapes);
    const auto add = [&](Group& group, std::size_t vertex) {
        group.shapes.resize(shapes);
        group.base.add(glm::dvec3(mesh.vertices[vertex].position));
        for (std::size_t i = 0; i < shapes; ++i)
            group.shapes[i].add(glm::dvec3(deformation.shapes[i].positions[vertex]));
    };
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
        add(all_, vertex);
        const std::size_t first = vertex * deformation.influences;
        for (std::size_t i = first; i < first + deformation.influences; ++i) {
            if (deformation.weights[i] == 0) continue;
            by_joint_.resize(std::max<std::size_t>(by_joint_.size(), deformation.joints[i] + 1));
            add(by_joint_[deformation.joints[i]], vertex);
        }
    }
}

Bounds MovingBounds::shaped(const Group& group, const std::vector<float>& weights) {
    Bounds result = group.base;
    for (std::size_t i = 0; i < std::min(weights.size(), group.shapes.size()); ++i) {
        const double weight = static_cast<double>(weights[i]);
        const glm::dvec3 a = weight * group.shapes[i].low, b = weight * group.shapes[i].high;
        result.low += glm::min(a, b);
        result.high += glm::max(a, b);
    }
    return result;
}

Bounds MovingBounds::at(const std::vector<float>& weights, const std::vector<glm::mat4>& joints) const {
    Bounds result;
    if (by_joint_.empty() || joints.empty()) {
        result = shaped(all_, weights);
    } else {
        // Weights sum to 1: every vertex lies between the places where its joints alone would put it.
        for (std::size_t joint = 0; joint < std::min(by_joint_.size(), joints.size()); ++joint) {
            if (by_joint_[joint].base.empty()) continue;
            result.add(shaped(by_joint_[joint], weights).transformed(glm::dmat4(joints[joint])));
        }
    }
    const glm::dvec3 error = deform_error * glm::max(glm::abs(result.low), glm::abs(result.high));
    result.low -= error;
    result.high += error;
    return result;
}

} // namespace postfx::host
