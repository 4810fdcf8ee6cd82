// A smooth way through space by arc length: what roads are laid on and things move along.
#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace postfx::host {

class Path {
public:
    Path() = default;
    /// A Catmull-Rom spline through at least two points (three if closed), metres.
    Path(const std::vector<glm::dvec3>& points, bool closed);

    double length() const { return along_.empty() ? 0 : along_.back(); }
    bool closed() const { return closed_; }

    struct Place {
        glm::dvec3 position{0};
        glm::dvec3 forward{0, 0, -1}; ///< unit
    };
    /// `metres` from the start; a closed path goes round, an open one ends at its ends.
    Place at(double metres) const;
    /// At that place with -z forward, +x to the right and the y axis as upright as it can be.
    glm::dmat4 frame(double metres) const;

    struct Nearest {
        double distance; ///< horizontal, metres
        double height;   ///< y of the path there
    };
    /// The point of the path nearest to (x, z), seen from above.
    Nearest nearest(double x, double z) const;

private:
    struct Block {
        glm::dvec2 center;
        double radius;
    };
    std::vector<glm::dvec3> points_; ///< densely sampled
    std::vector<double> along_;      ///< metres up to each point
    std::vector<Block> blocks_;      ///< circles around runs of points, to search fewer of them
    bool closed_ = false;
};

} // namespace postfx::host
