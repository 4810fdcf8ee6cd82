#include "photo_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace postfx::host {

std::optional<double> vertical_fov_of(const ShotData& shot, int width, int height) {
    if (!shot.focal_length_35mm || !(*shot.focal_length_35mm > 0)) return std::nullopt;
    const double half_diagonal_mm = std::hypot(36.0, 24.0) / 2;
    const double half_height_mm = half_diagonal_mm * height / std::hypot(width, height);
    return 2 * std::atan(half_height_mm / *shot.focal_length_35mm) * 180 / std::numbers::pi;
}

std::optional<double> distance_at(const Image& depth, const Camera& camera, PicturePoint point) {
    const auto pixel_of = [](double share, int pixels) {
        return std::clamp(static_cast<int>(std::floor(share * pixels)), 0, pixels - 1);
    };
    const int x = pixel_of(point.x, depth.width), y = depth.height - 1 - pixel_of(point.y, depth.height);
    // A hundredth of the height, and never one sample alone.
    const int radius = std::max(1, static_cast<int>(std::lround(0.01 * depth.height)));
    std::vector<double> distances;
    for (int row = std::max(0, y - radius); row <= std::min(depth.height - 1, y + radius); ++row)
        for (int column = std::max(0, x - radius); column <= std::min(depth.width - 1, x + radius);
             ++column) {
            const double z = camera.view_z(depth.at(column, row, 0));
            if (std::isfinite(z) && z > 0) distances.push_back(z);
        }
    if (distances.empty()) return std::nullopt;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
}

} // namespace postfx::host
