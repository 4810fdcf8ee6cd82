#include "depth_input.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace postfx::host {
namespace {

constexpr double default_fov = 45;
constexpr double default_near = 0.1;

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

} // namespace

void DepthOptions::declare(CLI::App& app) {
    kind_option_ =
        app.add_option(
               "--depth-kind", kind_,
               "What a depth sample means: z (metres along the view axis), distance (metres from the "
               "camera),\n"
               "window (0 near, 1 far), window-reversed (1 near, 0 far), window-reversed-infinite (near/z)")
            ->check(CLI::IsMember({"z", "distance", "window", "window-reversed", "window-reversed-infinite"}))
            ->capture_default_str();
    app.add_option("--depth-unit", depth_unit_, "Metres per unit of a z or distance sample")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--depth-nothing", nothing_,
                   "A further sample that means \"nothing there\" (0, negative, infinite and NaN always do)");
    app.add_option("--near", near_, "Near plane of window depth [m] (default 0.1)")
        ->check(CLI::PositiveNumber);
    app.add_option("--far", far_, "Far plane of window depth [m]")->check(CLI::PositiveNumber);
    app.add_option(
           "--projection", projection_,
           "OpenGL projection matrix of window depth instead of near, far and fov: 16 numbers, column by "
           "column")
        ->expected(16)
        ->default_str("");
    app.add_option("--fov", vertical_fov_, "Vertical field of view [degrees] (default 45)")
        ->check(CLI::Range(0.1, 179.0));
    app.add_option("--focal-length", focal_length_, "Instead of --fov: focal length [mm]")
        ->check(CLI::PositiveNumber);
    app.add_option("--sensor-height", sensor_height_, "Goes with --focal-length [mm]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--orthographic", orthographic_,
                   "Parallel view; the picture's height spans so many metres")
        ->check(CLI::PositiveNumber);
}

Camera DepthOptions::camera(int width, int height, std::optional<double> told_fov) const {
    if (vertical_fov_ && focal_length_) throw Error("--fov and --focal-length exclude each other");
    if (orthographic_ && (vertical_fov_ || focal_length_)) throw Error("--orthographic has no field of view");
    if (!projection_.empty() && (near_ || far_ || vertical_fov_ || focal_length_ || orthographic_)) {
        throw Error("--projection says near, far and field of view; don't give them twice");
    }
    if (!projection_.empty() && !is_window()) throw Error("--projection goes with --depth-kind window...");
    if ((near_ || far_) && !is_window()) throw Error("--near and --far go with --depth-kind window...");
    const bool needs_far = kind_ == "window" || kind_ == "window-reversed";
    if (needs_far && !far_ && projection_.empty()) {
        throw Error(fmt::format("--depth-kind {} needs --far (or --projection)", kind_));
    }
    const double near_plane = near_.value_or(default_near);
    if (far_ && *far_ <= near_plane)
        throw Error(fmt::format("--far {} is not beyond --near {}", *far_, near_plane));

    using DepthKind = Camera::DepthKind;
    const DepthKind kind = kind_ == "window"            ? DepthKind::standard
                           : kind_ == "window-reversed" ? DepthKind::reversed
                                                        : DepthKind::reversed_infinite;
    if (orthographic_) {
        if (kind_ == "window-reversed-infinite") throw Error("a parallel view has no infinite far plane");
        if (is_window()) return Camera::parallel(*orthographic_, near_plane, *far_, kind);
        // Samples are z itself; no place has z = 0, so it can mean "nothing".
        Camera camera = Camera::parallel(*orthographic_, 0, 1);
        camera.depth_scale = 1;
        camera.depth_offset = 0;
        camera.far_plane = std::numeric_limits<double>::infinity();
        return camera;
    }
    double fov = vertical_fov_.value_or(told_fov.value_or(default_fov));
    if (focal_length_) fov = degrees(2 * std::atan(sensor_height_ / (2 * *focal_length_)));
    Camera camera = Camera::perspective(fov, near_plane, far_.value_or(1), kind);
    if (!projection_.empty()) apply_projection(camera, width, height);
    return camera;
}

void DepthOptions::apply_projection(Camera& camera, int width, int height) const {
    const auto at = [&](int row, int column) {
        return projection_.at(4 * static_cast<std::size_t>(column) + static_cast<std::size_t>(row));
    };
    if (at(3, 2) != -1 || at(3, 3) != 0) {
        throw Error("--projection must be a perspective matrix (last row 0 0 -1 0), column by column");
    }
    const double aspect = static_cast<double>(width) / height;
    if (std::abs(at(1, 1) / at(0, 0) / aspect - 1) > 0.01) {
        throw Error(
            fmt::format("--projection is for a picture {:.4g} times as wide as high, this one is {:.4g}",
                        at(1, 1) / at(0, 0), aspect));
    }
    camera.vertical_fov = degrees(2 * std::atan(1 / at(1, 1)));
    // z_ndc = -p22 + p23 / z; window depth is z_ndc itself for reversed kinds (clip range 0..1), else (z_ndc
    // + 1) / 2.
    const double window_scale = kind_ == "window" ? 2 : 1, window_offset = kind_ == "window" ? -1 : 0;
    camera.depth_scale = window_scale / at(2, 3);
    camera.depth_offset = (window_offset + at(2, 2)) / at(2, 3);
    const double near_sample = kind_ == "window" ? 0 : 1;
    camera.near_plane = 1 / (camera.depth_scale * near_sample + camera.depth_offset);
    const double inverse_far = camera.depth_scale * camera.sky_depth + camera.depth_offset;
    camera.far_plane = inverse_far > 0 ? 1 / inverse_far : std::numeric_limits<double>::infinity();
}

bool DepthOptions::means_nothing(double z) const {
    return !(z > 0) || std::isinf(z) || (nothing_ && z == *nothing_);
}

Image DepthOptions::samples(const Image& depth, const Camera& camera) const {
    if (is_window()) return depth;
    Image result(depth.width, depth.height, 1);
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            double z = depth.at(x, y, 0);
            const bool nothing = means_nothing(z);
            z *= depth_unit_;
            if (kind_ == "distance") {
                const auto [right, up] = camera.view_plane(x + 0.5, y + 0.5, depth.width, depth.height);
                z /= std::sqrt(1 + right * right + up * up);
            }
            result.at(x, y, 0) = static_cast<float>(nothing ? camera.sky_depth : camera.depth_at(z));
        }
    }
    return result;
}

} // namespace postfx::host
