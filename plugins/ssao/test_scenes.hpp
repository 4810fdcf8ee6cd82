// Scenes of planes and spheres, with the closed form of what is seen in each pixel, for ssao's tests.
#pragma once

#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

namespace postfx::testing {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr double nowhere = std::numeric_limits<double>::infinity();

enum Level { low, medium, high, ultra, best, classic };
constexpr std::string_view word_of(Level level) {
    constexpr std::string_view words[] = {"low", "medium", "high", "ultra", "reference", "classic"};
    return words[level];
}
inline constexpr std::array approximations = {low, medium, high, ultra, best};

using Vector = std::array<double, 3>;
inline double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// origin + z * step is seen in the pixel, z metres along the view axis.
struct Ray {
    Vector origin, step;
};
struct Hit {
    double z = nowhere;
    Vector normal = {0, 0, 0};
};
using Surface = std::function<Hit(const Ray&)>;

inline Surface plane(const Vector& point, const Vector& normal) {
    return [=](const Ray& ray) {
        const Vector offset = {point[0] - ray.origin[0], point[1] - ray.origin[1], point[2] - ray.origin[2]};
        const double z = dot(offset, normal) / dot(ray.step, normal);
        return z > 0 && dot(ray.step, normal) < 0 ? Hit{z, normal} : Hit{};
    };
}

/// The side that faces the camera from outside, or from within (a bowl, where it is open to the camera).
inline Surface sphere(const Vector& center, double radius, bool from_within = false) {
    return [=](const Ray& ray) {
        const Vector offset = {ray.origin[0] - center[0], ray.origin[1] - center[1],
                               ray.origin[2] - center[2]};
        const double a = dot(ray.step, ray.step), b = dot(ray.step, offset);
        const double root = std::sqrt(b * b - a * (dot(offset, offset) - radius * radius));
        if (std::isnan(root)) return Hit{};
        Hit hit{(-b + (from_within ? root : -root)) / a};
        for (std::size_t i = 0; i < 3; ++i)
            hit.normal[i] = (from_within ? -1 : 1) * (offset[i] + hit.z * ray.step[i]) / radius;
        return hit;
    };
}

inline Surface nearest(const std::vector<Surface>& surfaces) {
    return [=](const Ray& ray) {
        Hit found;
        for (const Surface& surface : surfaces) {
            const Hit hit = surface(ray);
            if (hit.z < found.z) found = hit;
        }
        return found;
    };
}

inline Ray ray_of(const Camera& camera, int width, int height, int x, int y) {
    const double tall = camera.orthographic ? camera.vertical_extent : 2 * camera.tan_half_fov();
    const double right = (x + 0.5 - 0.5 * width) / height * tall;
    const double up = (y + 0.5 - 0.5 * height) / height * tall;
    if (camera.orthographic) return {{right, up, 0}, {0, 0, -1}};
    return {{0, 0, 0}, {right, up, -1}};
}

inline Input seen(const Surface& surface, int width, int height, const Camera& camera,
                  bool with_normals = true) {
    Input input{.color = noise(width, height, 0.5f, 4), .camera = camera};
    Image depth(width, height, 1), normal(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Hit hit = surface(ray_of(camera, width, height, x, y));
            depth.at(x, y, 0) = static_cast<float>(camera.depth_at(hit.z));
            for (int c = 0; c < 3; ++c)
                normal.at(x, y, c) = static_cast<float>(hit.normal[static_cast<std::size_t>(c)]);
        }
    }
    input.attachments = {{"depth", depth}, {"ambient", noise(width, height, 0, 0.5f, 3)}};
    if (with_normals) input.attachments["normal"] = normal;
    return input;
}

inline const Camera perspective = Camera::perspective(50, 0.1);
inline const Camera parallel = Camera::parallel(4, 0.1, 100);

/// A corner with two things in it, and sky above.
inline const Surface room = nearest({plane({0, -1, 0}, {0, 1, 0}), plane({-1.2, 0, 0}, {1, 0, 0}),
                                     [](const Ray& ray) {
                                         const Hit wall = plane({0, 0, -6}, {0, 0, 1})(ray);
                                         const double height = ray.origin[1] + wall.z * ray.step[1];
                                         return height < 1.1 ? wall : Hit{};
                                     },
                                     sphere({0.4, -0.5, -4.2}, 0.5), sphere({0.9, -0.8, -5.2}, 0.9)});

/// Floor and wall that meet at a right angle, both 45 degrees from the view axis; the foot lies at y = 0, z =
/// 5.
inline const double diagonal = std::sqrt(0.5);
inline const Surface valley = [](const Ray& ray) {
    const Hit floor = plane({0, 0, -5}, {0, diagonal, diagonal})(ray);
    const Hit wall = plane({0, 0, -5}, {0, -diagonal, diagonal})(ray);
    return floor.z < wall.z ? floor : wall;
};

inline Values at(Level level, Values more = {}) {
    more["quality"] = level;
    more["view"] = 1;
    return more;
}

inline Image visibility(const Input& input, Level level, const Values& more = {}) {
    return run_effect("ssao", input, at(level, more));
}

inline double root_mean_square(const Image& result, const Image64& expected) {
    double sum = 0;
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x)
            sum += std::pow(result.at(x, y, 0) - expected.at(x, y, 0), 2);
    }
    return std::sqrt(sum / static_cast<double>(result.pixel_count()));
}

inline double least(const Image& image) {
    double found = nowhere;
    for (std::size_t i = 0; i < image.values.size(); i += static_cast<std::size_t>(image.channels))
        found = std::min(found, static_cast<double>(image.values[i]));
    return found;
}

inline bool all_finite(const Image& image) {
    for (float value : image.values) {
        if (!std::isfinite(value)) return false;
    }
    return true;
}

} // namespace postfx::testing
