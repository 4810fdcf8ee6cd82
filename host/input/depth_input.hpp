// Depth and camera of images that someone else made.
#pragma once

#include <image/files.hpp>

#include <postfx/camera.hpp>
#include <postfx/image.hpp>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

/// Depth as effects want it.
struct DepthSamples {
    Image samples{};                     ///< of the picture's size; raw samples of DepthOptions::camera()
    std::vector<std::string> warnings{}; ///< what was brought into shape, one line each
    std::vector<std::string> remarks{};  ///< what seems not to have been meant
};

/// --depth-kind and what the camera was: how samples of a depth image become places.
class DepthOptions {
public:
    void declare(CLI::App& app);

    /// The camera for a picture of that size; `told_fov`: the vertical field of view that the picture's file tells, if
    /// it does [degrees]. Throws Error when options contradict each other.
    Camera camera(int width, int height, std::optional<double> told_fov = std::nullopt) const;

    /// The depth that belongs to `picture`, from the file `name`, seen by camera(): window depth as it is, other kinds turned into 1/z or z, and
    /// what means "nothing there" (0, negative, infinite, NaN, or --depth-nothing) into the sky's sample. Another size
    /// of the same shape is brought to the picture's, along its edges. Throws Error for another shape.
    DepthSamples read(const std::string& name, const ImageFile& depth, const Image& picture,
                      const Camera& camera) const;

private:
    bool is_window() const { return kind_.starts_with("window"); }
    Camera::DepthKind window_kind() const;
    void check_combinations() const;
    Camera orthographic_camera() const;
    Camera perspective_camera(std::optional<double> told_fov) const;
    Camera projected_camera(int width, int height) const;
    double metres(double sample, const ImageFile& depth) const;
    Image raw_samples(const ImageFile& depth, const Image& picture, const Camera& camera,
                      bool& any_nothing) const;

    std::string kind_ = "z";
    CLI::Option* given_kind_ = nullptr;
    std::optional<double> near_, far_, vertical_fov_, focal_length_, sensor_height_, orthographic_, nothing_,
        depth_unit_;
    std::vector<double> projection_, disparity_range_;
    bool flip_ = false;
};

} // namespace postfx::host
