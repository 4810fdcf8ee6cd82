// Where the vertices of a mesh with a deformation can be, without looking at each.
#pragma once

#include "geometry.hpp"

#include <vector>

namespace postfx::host {

class MovingBounds {
public:
    /// Looks through the mesh once.
    explicit MovingBounds(const Mesh& mesh);

    /// A box that holds every vertex of deform() with the same weights and joints.
    Bounds at(const std::vector<float>& weights, const std::vector<glm::mat4>& joints) const;

private:
    /// Vertices that one joint moves, or all of them: the undeformed ones, and how far a shape moves any of them.
    struct Group {
        Bounds base;
        std::vector<Bounds> shapes;
    };
    static Bounds shaped(const Group& group, const std::vector<float>& weights);

    Group all_;
    std::vector<Group> by_joint_;
};

} // namespace postfx::host
