// Depth and camera of images that someone else made.
#pragma once

#include <postfx/camera.hpp>
#include <postfx/image.hpp>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

/// --depth-kind and what the camera was: how samples of a depth image become places.
class DepthOptions {
public:
    void declare(CLI::App& app);

    /// The camera for a picture of that size; `told_fov`: the vertical field of view that the picture's file tells, if
    /// it does [degrees]. Throws Error when options contradict each other.
    Camera camera(int width, int height, std::optional<double> told_fov = std::nullopt) const;

    /// `depth` as raw samples of camera(): window depth as it is; distances turned into 1/z or z, and what
    /// means "nothing there" (0, negative, infinite, NaN, or --depth-nothing) into the sky's sample.
    Image samples(const Image& depth, const Camera& camera) const;

    /// Did the user say what a sample means?
    bool is_told() const { return kind_option_ && kind_option_->count() > 0; }

private:
    bool is_window() const { return kind_.starts_with("window"); }
    void apply_projection(Camera& camera, int width, int height) const;
    bool means_nothing(double z) const;

    const CLI::Option* kind_option_ = nullptr;
    std::string kind_ = "z";
    std::optional<double> near_, far_, vertical_fov_, focal_length_, orthographic_, nothing_;
    double sensor_height_ = 24;
    double depth_unit_ = 1;
    std::vector<double> projection_;
};

} // namespace postfx::host
