// Ambient occlusion of depth buffers of which it is known.
#include <truths/metric.hpp>

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace postfx::host {
namespace {

constexpr int width = 160, height = 120;

/// Of the pixel's ray: a line from the eye to 1 m along the view axis.
glm::dvec3 line_of(const Camera& camera, int x, int y) {
    const double pixel = 2 * camera.tan_half_fov() / height;
    return {(x + 0.5 - 0.5 * width) * pixel, (y + 0.5 - 0.5 * height) * pixel, -1};
}

/// Metres along the view axis to a plane through (0, 0, -distance); infinite where it is not seen.
double to_plane(const glm::dvec3& line, const glm::dvec3& normal, double distance) {
    const double toward = -glm::dot(line, normal);
    return toward > 0 ? distance * normal.z / toward : std::numeric_limits<double>::infinity();
}

/// Planes that meet before the eye at `distance`; the nearest is seen.
MethodInput planes(const std::vector<glm::dvec3>& normals, double distance) {
    MethodInput input{.color = Image(width, height, 3, 1), .camera = Camera::perspective(50, 0.1)};
    Image depth(width, height, 1), normal(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const glm::dvec3& n : normals) {
                const double z = to_plane(line_of(input.camera, x, y), n, distance);
                if (z >= nearest) continue;
                nearest = z;
                for (int c = 0; c < 3; ++c)
                    normal.at(x, y, c) = static_cast<float>(n[c]);
            }
            depth.at(x, y, 0) = static_cast<float>(input.camera.depth_at(nearest));
        }
    }
    input.attachments = {{"depth", depth}, {"normal", normal}, {"ambient", Image(width, height, 3, 1)}};
    return input;
}

Image64 visibility(const Method& method, const MethodInput& input, double radius) {
    const ChainEntry entry =
        entry_with(method, {{"radius", radius}, {"falloff", 0}, {"strength", 1}, {"view", 1}});
    return method.draw(entry, input);
}

/// Floor and wall at a right angle, both 45 degrees from the view axis: at d from the foot, a share of
/// (acos k - k sqrt(1 - k^2)) / pi is closed, k = d / radius.
double wall_error(const Method& method) {
    constexpr double distance = 5, radius = 0.8;
    const double half = std::sqrt(0.5);
    const MethodInput input = planes({{0, half, half}, {0, -half, half}}, distance);
    const Image64 result = visibility(method, input, radius);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 place =
                line_of(input.camera, x, y) * input.camera.view_z(input.attachments.at("depth").at(x, y, 0));
            const double from_foot = std::abs(place.y) / half;
            // Beyond the border no wall is known.
            const double to_border = (0.5 * width - std::abs(x + 0.5 - 0.5 * width)) / (0.5 * width);
            if (from_foot > 1.25 * radius || to_border < 0.4) continue;
            const double k = std::min(from_foot / radius, 1.0);
            const double expected = 1 - (std::acos(k) - k * std::sqrt(1 - k * k)) / std::numbers::pi;
            sum += std::pow(result.at(x, y, 0) - expected, 2);
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

double plane_error(const Method& method) {
    double worst = 0;
    for (const double degrees : {0, 30, 60, 75, 85}) {
        for (const double distance : {0.5, 5.0, 500.0}) {
            const double tilt = degrees * std::numbers::pi / 180;
            const glm::dvec3 normal(0.6 * std::sin(tilt), 0.8 * std::sin(tilt), std::cos(tilt));
            const Image64 result = visibility(method, planes({normal}, distance), 0.3 * distance);
            for (const double value : result.values)
                worst = std::max(worst, 1 - value);
        }
    }
    return worst;
}

const RegisterMetric
    registered_wall("ssao", "wall_error", "",
                    "root mean square error of visibility between floor and wall, where it is known",
                    wall_error);
const RegisterMetric registered_plane("ssao", "plane_error", "",
                                      "largest occlusion of planes tilted up to 85 degrees, which have none",
                                      plane_error);

} // namespace
} // namespace postfx::host
