// The model of README.md in float64, by brute force: every pixel along 64 slices, angles as angles. All levels but
// `classic`, which has a model of its own, approximate this one.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

using postfx::Camera;
using postfx::Image64;
using postfx::testing::ReferenceInput;

namespace {

constexpr int slices = 64;

using Vector = std::array<double, 3>;

Vector operator+(const Vector& a, const Vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator-(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator*(double factor, const Vector& a) {
    return {factor * a[0], factor * a[1], factor * a[2]};
}
double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) {
    return (1 / std::sqrt(dot(a, a))) * a;
}

class Scene {
public:
    explicit Scene(const ReferenceInput& input)
        : camera_(input.camera), depth_(input.attachments.at("depth")), width_(depth_.width),
          height_(depth_.height) {
        if (const auto found = input.attachments.find("normal"); found != input.attachments.end())
            normals_ = &found->second;
        tall_ = camera_.orthographic ? camera_.vertical_extent : 2 * camera_.tan_half_fov();
    }
    bool contains(int x, int y) const { return x >= 0 && x < width_ && y >= 0 && y < height_; }

    /// Metres along the view axis; nothing outside the picture, for the sky and for samples that mean no place.
    std::optional<double> distance(int x, int y) const {
        if (!contains(x, y)) return {};
        const double raw = depth_.at(x, y, 0);
        if (!std::isfinite(raw)) return {};
        const double z = camera_.view_z(raw);
        if (!std::isfinite(z) || z <= 0 || z >= 1e15) return {};
        return z;
    }
    std::optional<Vector> place(int x, int y) const {
        const std::optional<double> z = distance(x, y);
        if (!z) return {};
        const double metres = tall_ / height_ * (camera_.orthographic ? 1 : *z);
        const auto& [axis_right, axis_up] = camera_.principal_point;
        return Vector{(x + 0.5 - 0.5 * width_ * (1 + axis_right)) * metres,
                      (y + 0.5 - 0.5 * height_ * (1 + axis_up)) * metres, -*z};
    }
    Vector towards_eye(const Vector& point) const {
        return camera_.orthographic ? Vector{0, 0, 1} : unit(-1 * point);
    }
    /// On the screen [pixels], where a point seen in pixel x, y goes when it moves along `side`.
    std::array<double, 2> on_screen(const Vector& point, const Vector& side) const {
        if (camera_.orthographic) return {side[0], side[1]};
        return {side[0] + point[0] / -point[2] * side[2], side[1] + point[1] / -point[2] * side[2]};
    }
    std::optional<Vector> normal(int x, int y) const {
        if (!normals_) return rebuilt_normal(x, y);
        const Vector given = {normals_->at(x, y, 0), normals_->at(x, y, 1), normals_->at(x, y, 2)};
        const double length = std::sqrt(dot(given, given));
        if (!std::isfinite(length) || length < 0.1 || length > 10) return {};
        return unit(given);
    }

private:
    /// Affine on the screen over a plane of the scene.
    double affine(double z) const { return camera_.orthographic ? z : 1 / z; }
    /// From the pixel to a neighbour on the side that continues best to it, turned to the positive axis.
    Vector tangent(int x, int y, int dx, int dy, const Vector& here) const {
        double best = std::numeric_limits<double>::infinity();
        Vector found = {static_cast<double>(dx), static_cast<double>(dy), 0};
        if (!camera_.orthographic)
            found[2] = (here[0] * dx + here[1] * dy) / here[2]; // across the line of sight
        for (int side : {-1, 1}) {
            const int near_x = x + side * dx, near_y = y + side * dy;
            const int far_x = near_x + side * dx, far_y = near_y + side * dy;
            const std::optional<Vector> neighbour = place(near_x, near_y);
            if (!neighbour) continue;
            const std::optional<double> far = distance(far_x, far_y);
            const double bend =
                far ? std::abs(affine(-here[2]) - 2 * affine(-(*neighbour)[2]) + affine(*far)) : 1e38;
            if (bend >= best) continue;
            best = bend;
            found = side * (*neighbour - here);
        }
        return found;
    }
    std::optional<Vector> rebuilt_normal(int x, int y) const {
        const std::optional<Vector> here = place(x, y);
        if (!here) return {};
        return unit(cross(tangent(x, y, 1, 0, *here), tangent(x, y, 0, 1, *here)));
    }

    Camera camera_;
    const Image64& depth_;
    const Image64* normals_ = nullptr;
    int width_, height_;
    double tall_ = 0; ///< metres that the picture's height spans, at z = 1 m in perspective
};

/// Where a slice looks: the line of sight, a direction across it, and the surface's normal.
struct Slice {
    Vector point, eye, side, normal;
};

/// Elevation over the tangent plane [radians], at most a right angle, of the horizon on that side of the slice.
double horizon(const Scene& scene, const Slice& slice, int x, int y, double radius, double falloff) {
    const double to_eye = dot(slice.normal, slice.eye), to_side = dot(slice.normal, slice.side);
    const double in_slice = std::hypot(to_eye, to_side);
    const auto [right, up] = scene.on_screen(slice.point, slice.side);
    const double per_pixel = std::hypot(right, up);
    double highest = 0;
    int last_x = x, last_y = y;
    for (double away = 1;; away += 0.5) {
        const int at_x = static_cast<int>(std::floor(x + 0.5 + away * right / per_pixel));
        const int at_y = static_cast<int>(std::floor(y + 0.5 + away * up / per_pixel));
        if (!scene.contains(at_x, at_y)) break;
        if (at_x == last_x && at_y == last_y) continue;
        last_x = at_x;
        last_y = at_y;
        const std::optional<Vector> other = scene.place(at_x, at_y);
        if (!other) continue;
        const Vector offset = *other - slice.point;
        // Within the slice, this is the sine of the angle between its tangent and the way to the pixel.
        const double length = std::sqrt(dot(offset, offset));
        const double sine = dot(offset, slice.normal) / in_slice / length;
        if (sine <= 0 || length >= radius) continue;
        const double weight = falloff > 0 ? std::min(1.0, (1 - length / radius) / falloff) : 1;
        highest = std::max(highest, weight * (1 - std::cos(std::asin(std::min(sine, 1.0)))));
    }
    return std::acos(1 - highest);
}

/// Integral of cos(angle to the normal) times sine over angles from the line of sight, from 0.
double light_below(double angle, double to_eye, double to_side) {
    const double sine = std::sin(angle);
    return (to_eye * sine * sine + to_side * (angle - sine * std::cos(angle))) / 2;
}

double occlusion(const Scene& scene, int x, int y, double radius, double falloff) {
    const std::optional<Vector> point = scene.place(x, y);
    std::optional<Vector> normal = scene.normal(x, y);
    if (!point || !normal) return 0;
    const Vector eye = scene.towards_eye(*point);
    const double facing = dot(*normal, eye);
    if (facing < 0.01) normal = unit(*normal + (0.01 - facing) * eye);
    const Vector first = unit(Vector{1, 0, 0} - eye[0] * eye);
    const Vector second = cross(eye, first);
    double lost = 0;
    for (int i = 0; i < 2 * slices; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / slices;
        const Slice slice = {*point, eye, std::cos(angle) * first + std::sin(angle) * second, *normal};
        const double to_eye = dot(*normal, eye), to_side = dot(*normal, slice.side);
        const double tangent = std::numbers::pi / 2 + std::atan2(to_side, to_eye);
        const double open = std::max(0.0, tangent - horizon(scene, slice, x, y, radius, falloff));
        lost += light_below(tangent, to_eye, to_side) - light_below(open, to_eye, to_side);
    }
    return std::clamp(lost / slices, 0.0, 1.0);
}

/// Share of 80 pixels in a grid that are nearer by less than the radius.
double classic_occlusion(const Scene& scene, int x, int y, int width, int height, double radius) {
    const std::optional<double> own = scene.distance(x, y);
    if (!own || !scene.normal(x, y)) return 0;
    const int stride = 1 + height / 240;
    int nearer = 0;
    for (int i = 0; i < 81; ++i) {
        const int at_x = std::clamp(x + stride * (i % 9 - 4), 0, width - 1);
        const int at_y = std::clamp(y + stride * (i / 9 - 4), 0, height - 1);
        const std::optional<double> other = scene.distance(at_x, at_y);
        nearer += other && *other < *own && *own - *other < radius;
    }
    return nearer / 80.0;
}

} // namespace

Image64 postfx::testing::reference(const ReferenceInput& input) {
    const Scene scene(input);
    const auto ambient = input.attachments.find("ambient");
    const double radius = input.value("radius");
    Image64 result(input.color.width, input.color.height, 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const double occluded =
                input.value("strength")
                * (input.level == "classic"
                       ? classic_occlusion(scene, x, y, result.width, result.height, radius)
                       : occlusion(scene, x, y, radius, input.value("falloff")));
            for (int c = 0; c < 3; ++c) {
                const double color = input.color.at(x, y, c);
                const double share = ambient == input.attachments.end() ? color : ambient->second.at(x, y, c);
                const double lost = std::clamp(occluded * share, 0.0, std::max(color, 0.0));
                result.at(x, y, c) = input.value("view") == 1 ? 1 - occluded : color - lost;
            }
        }
    }
    return result;
}
