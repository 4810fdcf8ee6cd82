#include "view_bounds.hpp"

#include "projection.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace postfx::host {
namespace {

/// Vertices go through four sums of three products in float32, of numbers as large as the distances from the node's
/// origin and from the eye: less than 16 roundings of 2^-24.
constexpr double position_error = 1e-6;

/// Of a depth sample, interpolated in float32 over a triangle that may lie mostly out of view: up to 1e-6 was seen.
constexpr double depth_error = 4e-6;

/// The view as a convex solid of view space, x right, y up, looking along -z. Parallel cameras have a far side.
struct Frustum {
    std::vector<glm::dvec4> sides; ///< a point is inside where dot(side, (point, 1)) >= 0, metres
    std::vector<glm::dvec3> corners;
};

Frustum frustum_of(const Camera& camera, const Projection& projection) {
    Frustum result;
    const double near = camera.near_plane, far = camera.far_plane;
    const double slope = camera.orthographic ? 0 : 1, constant = 1 - slope;
    const glm::dvec2 low = projection.plane({-1, -1}), high = projection.plane({1, 1});
    for (const double sign : {-1.0, 1.0}) {
        const glm::dvec2 away = sign < 0 ? high : -low; // of that side from the view axis
        result.sides.push_back(glm::dvec4(sign, 0, -slope * away.x, constant * away.x)
                               / std::hypot(1, slope * away.x));
        result.sides.push_back(glm::dvec4(0, sign, -slope * away.y, constant * away.y)
                               / std::hypot(1, slope * away.y));
    }
    result.sides.emplace_back(0, 0, -1, -near);
    if (camera.orthographic) result.sides.emplace_back(0, 0, 1, far);
    for (const double z : {near, far}) {
        if (z == far && !camera.orthographic) break;
        const double scale = constant + slope * z;
        for (const double x : {low.x, high.x}) {
            for (const double y : {low.y, high.y})
                result.corners.emplace_back(scale * x, scale * y, -z);
        }
    }
    return result;
}

using Polygon = std::vector<glm::dvec3>;

/// The part of a convex polygon on the inner side (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, glm::dvec4 side) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double inside_a = glm::dot(side, glm::dvec4(a, 1)), inside_b = glm::dot(side, glm::dvec4(b, 1));
        if (inside_a >= 0) result.push_back(a);
        if ((inside_a >= 0) != (inside_b >= 0))
            result.push_back(glm::mix(a, b, inside_a / (inside_a - inside_b)));
    }
    return result;
}

using Corners = std::array<glm::dvec3, 8>; ///< bit 0 of the index: high x, 1: high y, 2: high z

Corners corners_of(glm::dvec3 low, glm::dvec3 high, const glm::dmat4& to_view) {
    Corners corners;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 point(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
        corners[static_cast<std::size_t>(i)] = glm::dvec3(to_view * glm::dvec4(point, 1));
    }
    return corners;
}

/// The corners of what box and view share, in view space; none where they share nothing. `slack`: metres that the box
/// may reach further than it says.
Polygon shared_corners(const Corners& box, glm::dvec3 low, glm::dvec3 high, const glm::dmat4& to_view,
                       const Frustum& frustum, double slack) {
    bool cut = false;
    for (const glm::dvec4& side : frustum.sides) {
        const auto beyond = std::count_if(box.begin(), box.end(), [&](const glm::dvec3& corner) {
            return glm::dot(side, glm::dvec4(corner, 1)) < -slack;
        });
        if (beyond == 8) return {};
        cut = cut || beyond > 0;
    }
    if (!cut) return {box.begin(), box.end()};

    constexpr std::size_t faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    Polygon shared;
    for (const auto& face : faces) {
        Polygon polygon;
        for (const std::size_t corner : face)
            polygon.push_back(box[corner]);
        for (glm::dvec4 side : frustum.sides) {
            side.w += slack;
            polygon = clipped(polygon, side);
        }
        shared.insert(shared.end(), polygon.begin(), polygon.end());
    }
    // A flat box has no inverse, and no inside.
    const glm::dmat4 to_box = glm::inverse(to_view);
    for (const glm::dvec3& corner : frustum.corners) {
        const glm::dvec3 point(to_box * glm::dvec4(corner, 1));
        if (glm::all(glm::greaterThanEqual(point, low)) && glm::all(glm::lessThanEqual(point, high)))
            shared.push_back(corner);
    }
    return shared;
}

/// What depth samples of such surfaces may say.
SceneBounds seen_through_depth(SceneBounds bounds, const Camera& camera, double eye_height, double pixel) {
    const double exact_farthest = bounds.farthest;
    if (camera.orthographic) {
        const double error = depth_error * (camera.far_plane - camera.near_plane);
        bounds.nearest -= error;
        bounds.farthest += error;
        bounds.reach = bounds.farthest;
        bounds.lowest -= error + pixel;
        bounds.highest += error + pixel;
    } else {
        const double error = depth_error / camera.near_plane;
        bounds.nearest = 1 / (1 / bounds.nearest + error);
        const double inverse = 1 / exact_farthest - error;
        bounds.farthest = inverse > 0 ? 1 / inverse : SceneBounds::infinity;
        const double ratio = bounds.farthest / exact_farthest;
        const double beside = pixel * bounds.farthest;
        bounds.reach = bounds.reach * ratio + beside;
        const double height =
            std::max(std::abs(bounds.lowest - eye_height), std::abs(bounds.highest - eye_height));
        const double error_of_height = height * (ratio - 1) + beside;
        bounds.lowest -= error_of_height;
        bounds.highest += error_of_height;
    }
    bounds.nearest = std::max(bounds.nearest, camera.near_plane);
    return bounds;
}

bool shines(glm::vec3 color) {
    return color != glm::vec3(0);
}

/// Does shaders/scene/shade.glsl give it ambient light? Everything mirrors the background at grazing angles.
bool lit_by(const Surroundings& around, const Material& material) {
    const bool mirrors = shines(around.zenith) || shines(around.horizon) || shines(around.ground);
    const bool ambient = shines(around.ambient_up) || shines(around.ambient_down);
    return !material.unlit && (mirrors || (ambient && shines(material.diffuse)));
}

} // namespace

ViewBounds::ViewBounds(const Scene& scene) : scene_(scene) {
    std::map<const Mesh*, Bounds> known;
    std::map<const Mesh*, std::shared_ptr<const MovingBounds>> known_moving;
    for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
        for (const Part& part : scene.nodes[node].parts) {
            if (part.mesh->indices.empty()) continue;
            const auto [bounds, is_new] = known.try_emplace(part.mesh.get());
            if (is_new) bounds->second = part.mesh->bounds();
            const Material& material = scene.materials[part.material];
            std::shared_ptr<const MovingBounds> moving;
            if (part.mesh->deformation) {
                std::shared_ptr<const MovingBounds>& shared = known_moving[part.mesh.get()];
                if (!shared) shared = std::make_shared<const MovingBounds>(*part.mesh);
                moving = shared;
            }
            boxes_.push_back({node, bounds->second, !material.blended, shines(material.emission),
                              lit_by(scene.surroundings, material), std::move(moving)});
        }
    }
}

SceneBounds ViewBounds::at(double time, const Camera& camera, int width, int height) {
    scene_.place_nodes(time, nodes_);
    const Projection projection = make_projection(camera, static_cast<double>(width) / height);
    const Frustum frustum = frustum_of(camera, projection);
    const glm::dmat4 view_to_world = glm::make_mat4(camera.view_to_world.data());
    const glm::dmat4 world_to_view = glm::inverse(view_to_world);

    SceneBounds bounds{.nearest = SceneBounds::infinity,
                       .farthest = 0,
                       .reach = 0,
                       .lowest = SceneBounds::infinity,
                       .highest = -SceneBounds::infinity,
                       .empty = {}};
    bool surfaces = false, emission = false, ambient = false;
    for (PartBox& box : boxes_) {
        if (box.moving) {
            box.box =
                box.moving->at(scene_.shape_weights(box.node, time), scene_.joint_matrices(box.node, nodes_));
        }
        const glm::dmat4 to_view = world_to_view * nodes_[box.node];
        const Corners corners = corners_of(box.box.low, box.box.high, to_view);
        double reach = 0;
        for (const glm::dvec3& corner : corners)
            reach = std::max(reach, glm::length(corner));
        const double slack = position_error * (2 * glm::length(glm::dvec3(to_view[3])) + reach);
        const Polygon shared = shared_corners(corners, box.box.low, box.box.high, to_view, frustum, slack);
        if (shared.empty()) continue;
        emission = emission || box.emits;
        ambient = ambient || box.lit_by_surroundings;
        if (!box.opaque) continue;
        surfaces = true;
        for (const glm::dvec3& point : shared) {
            bounds.nearest = std::min(bounds.nearest, -point.z - slack);
            bounds.farthest = std::max(bounds.farthest, -point.z + slack);
            bounds.reach = std::max(bounds.reach, glm::length(point) + slack);
            const double y = (view_to_world * glm::dvec4(point, 1)).y;
            bounds.lowest = std::min(bounds.lowest, y - slack);
            bounds.highest = std::max(bounds.highest, y + slack);
        }
    }
    if (surfaces) {
        bounds.nearest = std::max(bounds.nearest, camera.near_plane);
        // A sample may lie half a pixel beside the place that it stands for, across as well as up.
        const double pixel = std::sqrt(2.0) * projection.half_extent.y / height;
        bounds = seen_through_depth(bounds, camera, view_to_world[3].y, pixel);
    } else {
        bounds = {};
        bounds.empty = {"depth", "normal"};
    }
    if (!emission) bounds.empty.emplace_back("emission");
    if (!ambient) bounds.empty.emplace_back("ambient");
    return bounds;
}

} // namespace postfx::host
