#include "path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace postfx::host {
namespace {

constexpr std::size_t block_points = 16;

glm::dvec3 catmull_rom(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                       double t) {
    return 0.5
           * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t)
              + (3.0 * (b - c) + d - a) * (t * t * t));
}

} // namespace

Path::Path(const std::vector<glm::dvec3>& points, bool closed) : closed_(closed) {
    const auto count = static_cast<int>(points.size());
    const auto point = [&](int i) {
        return points[static_cast<std::size_t>(closed ? (i + count) % count : std::clamp(i, 0, count - 1))];
    };
    const int pieces = closed ? count : count - 1;
    for (int i = 0; i < pieces; ++i) {
        const double chord = glm::length(point(i + 1) - point(i));
        const int steps = std::clamp(static_cast<int>(std::ceil(chord)), 1, 1000); // about a metre each
        for (int k = 0; k < steps; ++k) {
            points_.push_back(catmull_rom(point(i - 1), point(i), point(i + 1), point(i + 2),
                                          static_cast<double>(k) / static_cast<double>(steps)));
        }
    }
    points_.push_back(point(closed ? 0 : count - 1));

    along_.push_back(0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
        along_.push_back(along_.back() + glm::length(points_[i] - points_[i - 1]));
    }
    for (std::size_t first = 0; first + 1 < points_.size(); first += block_points) {
        const std::size_t last = std::min(first + block_points, points_.size() - 1);
        const glm::dvec3& middle = points_[(first + last) / 2];
        Block block{{middle.x, middle.z}, 0};
        for (std::size_t i = first; i <= last; ++i) {
            block.radius =
                std::max(block.radius, glm::length(glm::dvec2(points_[i].x, points_[i].z) - block.center));
        }
        blocks_.push_back(block);
    }
}

Path::Place Path::at(double metres) const {
    const double total = length();
    if (!(total > 0)) return {points_.empty() ? glm::dvec3(0) : points_.front(), {0, 0, -1}};
    const double wanted =
        closed_ ? metres - total * std::floor(metres / total) : std::clamp(metres, 0.0, total);
    const auto above = std::upper_bound(along_.begin() + 1, along_.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(above - along_.begin());
    const double t =
        std::clamp((wanted - along_[i - 1]) / std::max(along_[i] - along_[i - 1], 1e-9), 0.0, 1.0);

    // Directions at the two points are averages of the pieces around them, so that turning is smooth.
    const auto direction = [&](std::size_t k) {
        const std::size_t last = points_.size() - 1;
        const glm::dvec3& before = k > 0 ? points_[k - 1] : (closed_ ? points_[last - 1] : points_[0]);
        const glm::dvec3& after = k < last ? points_[k + 1] : (closed_ ? points_[1] : points_[last]);
        return after - before;
    };
    const glm::dvec3 forward = glm::mix(glm::normalize(direction(i - 1)), glm::normalize(direction(i)), t);
    return {glm::mix(points_[i - 1], points_[i], t), glm::normalize(forward)};
}

glm::dmat4 Path::frame(double metres) const {
    const Place place = at(metres);
    const glm::dvec3 right = glm::normalize(glm::cross(place.forward, glm::dvec3(0, 1, 0)));
    const glm::dvec3 up = glm::cross(right, place.forward);
    return {glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(-place.forward, 0),
            glm::dvec4(place.position, 1)};
}

Path::Nearest Path::nearest(double x, double z) const {
    const glm::dvec2 here(x, z);
    Nearest best{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        if (glm::length(here - blocks_[b].center) - blocks_[b].radius > best.distance) continue;
        const std::size_t last = std::min((b + 1) * block_points, points_.size() - 1);
        for (std::size_t i = b * block_points; i < last; ++i) {
            const glm::dvec2 start(points_[i].x, points_[i].z), end(points_[i + 1].x, points_[i + 1].z);
            const glm::dvec2 piece = end - start;
            const double t =
                std::clamp(glm::dot(here - start, piece) / std::max(glm::dot(piece, piece), 1e-12), 0.0, 1.0);
            const double distance = glm::length(here - start - t * piece);
            if (distance < best.distance) best = {distance, glm::mix(points_[i].y, points_[i + 1].y, t)};
        }
    }
    return best;
}

} // namespace postfx::host
