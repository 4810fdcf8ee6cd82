#include "height_field.hpp"

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// Light that a half of a slice gets from elevations below `elevation`: the integral of
/// sin(e) sin(to_eye - e), the cosine to the surface's normal within the slice times the width of a slice there.
double light_below(double elevation, double to_eye) {
    return (std::sin(2 * elevation - to_eye) + std::sin(to_eye) - 2 * elevation * std::cos(to_eye)) / 4;
}

} // namespace

struct HeightField::Point {
    int x, y;
    glm::dvec3 place;  ///< view space, metres
    glm::dvec3 normal; ///< unit, not away from the eye
};

/// The plane of the slice is that of `along` and the normal's part in it, which stands over `along`.
struct HeightField::Side {
    glm::dvec3 along; ///< unit, on the tangent plane, away from the line of sight
    double in_slice;  ///< length of the normal's part
    double to_eye;    ///< angle from `along` to the line of sight
    glm::dvec2 step;  ///< where it runs on the screen; the larger component is 1 pixel
};

HeightField::HeightField(const Image& depth, const Image& normal, const Camera& camera, double radius,
                         double falloff)
    : width_(depth.width), height_(depth.height), parallel_(camera.orthographic), radius_(radius),
      falloff_(falloff),
      pixel_((parallel_ ? camera.vertical_extent : 2 * camera.tan_half_fov()) / depth.height),
      axis_(0.5 * depth.width * (1 + camera.principal_point[0]),
            0.5 * depth.height * (1 + camera.principal_point[1])),
      distance_(depth.pixel_count()), normal_(depth.pixel_count()) {
    for (std::size_t i = 0; i < distance_.size(); ++i) {
        const double z = camera.view_z(depth.values[i]);
        const float* n = &normal.values[i * static_cast<std::size_t>(normal.channels)];
        const glm::dvec3 given(n[0], n[1], n[2]);
        const double length = glm::length(given);
        distance_[i] = std::isfinite(z) && z > 0 ? z : 0;
        if (std::isfinite(length) && length > 0) normal_[i] = given / length;
    }
}

glm::dvec3 HeightField::place(int x, int y) const {
    const double z = distance_[index(x, y)], metres = pixel_ * (parallel_ ? 1 : z);
    return {(x + 0.5 - axis_.x) * metres, (y + 0.5 - axis_.y) * metres, -z};
}

double HeightField::visibility(int x, int y, double angle) const {
    if (distance_[index(x, y)] == 0 || normal_[index(x, y)] == glm::dvec3(0)) return 1;
    Point point{x, y, place(x, y), normal_[index(x, y)]};
    const glm::dvec3 eye = parallel_ ? glm::dvec3(0, 0, 1) : -glm::normalize(point.place);
    // Normals that are shaded may look away from the eye, to which the surface is in view all the same.
    if (glm::dot(point.normal, eye) < 0)
        point.normal = glm::normalize(point.normal - glm::dot(point.normal, eye) * eye);
    const glm::dvec3 right = glm::normalize(glm::dvec3(1, 0, 0) - eye.x * eye), up = glm::cross(eye, right);
    double result = 1;
    for (const double sign : {1.0, -1.0}) {
        const glm::dvec3 away = sign * (std::cos(angle) * right + std::sin(angle) * up);
        const double toward_eye = std::max(0.0, glm::dot(point.normal, eye)),
                     sideways = glm::dot(point.normal, away);
        const double in_slice = std::hypot(toward_eye, sideways);
        if (in_slice == 0) continue;
        glm::dvec2 step(away);
        if (!parallel_) step -= glm::dvec2(point.place) / point.place.z * away.z;
        step /= std::max(std::abs(step.x), std::abs(step.y));
        const Side side = {.along = (toward_eye * away - sideways * eye) / in_slice,
                           .in_slice = in_slice,
                           .to_eye = std::atan2(toward_eye, -sideways),
                           .step = step};
        result -= lost(point, side);
    }
    return result;
}

double HeightField::reach(const Point& point, glm::dvec2 step) const {
    if (parallel_) return radius_ / (pixel_ * glm::length(step));
    const double distance = glm::length(point.place);
    if (distance <= radius_) return width_ + height_;
    // Lines of sight that touch the sphere make an angle with this tangent; along the step that angle has
    // s * across / (squared + s * forward).
    const double tangent = radius_ / std::sqrt(distance * distance - radius_ * radius_);
    const glm::dvec3 line = point.place / -point.place.z, move(pixel_ * step, 0);
    const double squared = glm::dot(line, line), forward = glm::dot(line, move),
                 across = glm::length(glm::cross(line, move));
    const double rest = across - tangent * forward;
    return rest > 0 ? tangent * squared / rest : width_ + height_;
}

double HeightField::lost(const Point& point, const Side& side) const {
    // Every pixel that the slice's line crosses (Amanatides and Woo 1987), in steps between the borders of pixels.
    const double end = reach(point, side.step) + 1; // a pixel's middle may lie before its border
    glm::ivec2 at(point.x, point.y);
    const glm::ivec2 size(width_, height_), direction(side.step.x > 0 ? 1 : -1, side.step.y > 0 ? 1 : -1);
    const glm::dvec2 between = 1.0 / glm::max(glm::abs(side.step), glm::dvec2(1e-12));
    glm::dvec2 next = 0.5 * between;
    double highest = 0;
    for (;;) {
        const int axis = next.x < next.y ? 0 : 1;
        at[axis] += direction[axis];
        if (next[axis] > end || at[axis] < 0 || at[axis] >= size[axis]) break;
        next[axis] += between[axis];
        highest = std::max(highest, lift(point, side, at.x, at.y));
    }
    return side.in_slice * light_below(std::min(std::acos(1 - highest), side.to_eye), side.to_eye);
}

double HeightField::lift(const Point& point, const Side& side, int x, int y) const {
    if (distance_[index(x, y)] == 0) return 0;
    const glm::dvec3 offset = place(x, y) - point.place;
    // The pixel's middle lies beside the slice: it is moved into it parallel to the tangent plane, over which it
    // keeps its height, so that no part of a plane rises over it. A low one may so come to lie over the slice's
    // beginning, on a steep slope; then its whole distance has to do.
    const double above = glm::dot(offset, point.normal) / side.in_slice, distance = glm::length(offset);
    if (above <= 0 || distance >= radius_) return 0;
    const double along = above < 0.1 * distance ? std::sqrt(distance * distance - above * above)
                                                : std::abs(glm::dot(offset, side.along));
    const double rest = 1 - distance / radius_, weight = falloff_ > 0 ? std::min(1.0, rest / falloff_) : 1;
    return weight * (1 - along / std::hypot(along, above));
}

} // namespace postfx::host
