#include "depth_input.hpp"

#include "terminal/number_checks.hpp"

#include <base/projection_matrix.hpp>
#include <image/joint_bilateral.hpp>
#include <image/matches_sample.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace postfx::host {
namespace {

constexpr double default_fov = 45;
constexpr double default_near = 0.1;
constexpr double default_sensor_height = 24;
constexpr double infinity = std::numeric_limits<double>::infinity();

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

/// Linear, beyond 0..1 too. NaN for NaN, which std::lerp makes a number of.
double between(double at_zero, double at_one, double sample) {
    return at_zero + (at_one - at_zero) * sample;
}

/// Samples of parallel views that are z itself; no place has z = 0, so it can mean "nothing".
Camera with_metres_as_samples(Camera camera) {
    camera.near_plane = 0;
    camera.far_plane = infinity;
    camera.depth_scale = 1;
    camera.depth_offset = 0;
    camera.sky_depth = 0;
    return camera;
}

Image flipped(const Image& image) {
    Image result(image.width, image.height, image.channels);
    const std::size_t row = static_cast<std::size_t>(image.width) * image.channels;
    for (int y = 0; y < image.height; ++y)
        std::copy_n(image.pixel(0, y), row, result.pixel(0, image.height - 1 - y));
    return result;
}

/// Of one shape, but for the whole pixels that sides are rounded to, up or down?
bool same_shape(const Image& a, const Image& b) {
    const double across = static_cast<double>(a.width) / b.width;
    const double up = static_cast<double>(a.height) / b.height;
    return std::abs(across * b.height - a.height) < 1 || std::abs(up * b.width - a.width) < 1;
}

/// A depth shown in colours is none: which of its channels would be?
void expect_grey(const std::string& name, const ImageFile& depth) {
    if (depth.image.channels < 3) return;
    // A grey JPEG with channels of colour comes apart by a code or two.
    const float rounding = depth.coding.numbers == Coding::Numbers::codes ? 2.5f / 255 : 0;
    for (std::size_t i = 0; i < depth.image.values.size();
         i += static_cast<std::size_t>(depth.image.channels)) {
        const float* sample = &depth.image.values[i];
        for (int channel = 1; channel < 3; ++channel)
            if (std::abs(sample[channel] - sample[0]) > rounding)
                throw Error(Place{.file = name}, "has three different channels, so it is no depth");
    }
}

/// Raw samples as what is affine over the picture on planes, 0 for the sky, or back.
Image converted(Image image, const Camera& camera, bool back) {
    for (float& value : image.values) {
        const auto sample = static_cast<double>(value);
        if (back) {
            const double z = camera.orthographic ? sample : 1 / sample;
            value = static_cast<float>(sample > 0 ? camera.depth_at(z) : camera.sky_depth);
        } else {
            const double z = camera.view_z(sample);
            const bool place = z > 0 && std::isfinite(z);
            value = static_cast<float>(!place ? 0 : camera.orthographic ? z : 1 / z);
        }
    }
    return image;
}

} // namespace

void DepthOptions::declare(CLI::App& app) {
    given_kind_ =
        app.add_option(
               "--depth-kind", kind_,
               "What a depth sample means: z (metres along the view axis), distance (metres from the "
               "camera),\n"
               "inverse (1 / z), disparity (see --disparity-range), window (0 near, 1 far), window-reversed\n"
               "(1 near, 0 far), window-reversed-infinite (near/z)")
            ->check(CLI::IsMember({"z", "distance", "inverse", "disparity", "window", "window-reversed",
                                   "window-reversed-infinite"}))
            ->capture_default_str();
    app.add_option("--depth-unit", depth_unit_, "Metres per unit of z, distance or 1 / inverse (default 1)")
        ->check(finite())
        ->check(CLI::PositiveNumber);
    app.add_option("--disparity-range", disparity_range_,
                   "Dioptres (1/m) that the disparities 0 and 1 stand for, linear between")
        ->expected(2)
        ->check(finite())
        ->check(CLI::NonNegativeNumber)
        ->type_name("AT0 AT1")
        ->default_str("");
    app.add_option("--depth-nothing", nothing_,
                   "A further sample that means \"nothing there\" (0, negative, infinite and NaN always do)");
    app.add_flag("--depth-flip", flip_, "The depth's rows are upside down");
    app.add_option("--near", near_, "Near plane of window depth [m] (default 0.1)")
        ->check(finite())
        ->check(CLI::PositiveNumber);
    app.add_option("--far", far_, "Far plane of window depth [m]")
        ->check(finite())
        ->check(CLI::PositiveNumber);
    app.add_option(
           "--projection", projection_,
           "OpenGL projection matrix instead of near, far and fov, off-centre or not: 16 numbers, column by "
           "column")
        ->expected(16)
        ->check(finite())
        ->default_str("");
    app.add_option("--fov", vertical_fov_, "Vertical field of view [degrees] (default 45)")
        ->check(finite())
        ->check(CLI::Range(0.1, 179.0));
    app.add_option("--focal-length", focal_length_, "Instead of --fov: focal length [mm]")
        ->check(finite())
        ->check(CLI::PositiveNumber);
    app.add_option("--sensor-height", sensor_height_, "Goes with --focal-length [mm] (default 24)")
        ->check(finite())
        ->check(CLI::PositiveNumber);
    app.add_option("--orthographic", orthographic_,
                   "Parallel view; the picture's height spans so many metres")
        ->check(finite())
        ->check(CLI::PositiveNumber);
}

Camera::DepthKind DepthOptions::window_kind() const {
    return kind_ == "window"            ? Camera::DepthKind::standard
           : kind_ == "window-reversed" ? Camera::DepthKind::reversed
                                        : Camera::DepthKind::reversed_infinite;
}

void DepthOptions::check_combinations() const {
    if (vertical_fov_ && focal_length_) throw Error("--fov and --focal-length exclude each other");
    if (sensor_height_ && !focal_length_) throw Error("--sensor-height goes with --focal-length");
    if (orthographic_ && (vertical_fov_ || focal_length_)) throw Error("--orthographic has no field of view");
    if (!projection_.empty() && (near_ || far_ || vertical_fov_ || focal_length_ || orthographic_)) {
        throw Error("--projection says near, far and field of view; don't give them twice");
    }
    if ((near_ || far_) && !is_window()) throw Error("--near and --far go with --depth-kind window...");
    const bool needs_far = kind_ == "window" || kind_ == "window-reversed";
    if (needs_far && !far_ && projection_.empty()) {
        throw Error(fmt::format("--depth-kind {} needs --far (or --projection)", kind_));
    }
    const double near_plane = near_.value_or(default_near);
    if (far_ && *far_ <= near_plane)
        throw Error(fmt::format("--far {} is not beyond --near {}", *far_, near_plane));
    if (depth_unit_ && kind_ != "z" && kind_ != "distance" && kind_ != "inverse")
        throw Error(fmt::format("--depth-unit goes with --depth-kind z, distance or inverse, not {}", kind_));
    if ((kind_ == "disparity") != !disparity_range_.empty())
        throw Error("--depth-kind disparity and --disparity-range go together");
    if (!disparity_range_.empty() && disparity_range_[0] == disparity_range_[1])
        throw Error("--disparity-range has twice the same number: all places would be equally far");
}

Camera DepthOptions::camera(int width, int height, std::optional<double> told_fov) const {
    check_combinations();
    if (!projection_.empty()) return projected_camera(width, height);
    return orthographic_ ? orthographic_camera() : perspective_camera(told_fov);
}

Camera DepthOptions::orthographic_camera() const {
    if (kind_ == "window-reversed-infinite") throw Error("a parallel view has no infinite far plane");
    if (is_window())
        return Camera::parallel(*orthographic_, near_.value_or(default_near), *far_, window_kind());
    return with_metres_as_samples(Camera::parallel(*orthographic_, 0, 1));
}

Camera DepthOptions::perspective_camera(std::optional<double> told_fov) const {
    double fov = vertical_fov_.value_or(told_fov.value_or(default_fov));
    if (focal_length_)
        fov = degrees(2 * std::atan(sensor_height_.value_or(default_sensor_height) / (2 * *focal_length_)));
    return Camera::perspective(fov, near_.value_or(default_near), far_.value_or(1), window_kind());
}

Camera DepthOptions::projected_camera(int width, int height) const {
    ProjectionMatrix matrix{};
    std::copy(projection_.begin(), projection_.end(), matrix.begin());
    const std::optional<Camera::DepthKind> kind =
        is_window() ? std::optional(window_kind()) : std::optional<Camera::DepthKind>();
    Camera camera = camera_of(matrix, kind, width, height);
    if (!camera.orthographic) return camera;
    if (kind_ == "window-reversed-infinite") throw Error("a parallel view has no infinite far plane");
    return is_window() ? camera : with_metres_as_samples(camera);
}

double DepthOptions::metres(double sample, const ImageFile& depth) const {
    const double unit = depth_unit_.value_or(1);
    if (depth.depth_scale && given_kind_->count() == 0) {
        const double number = between(depth.depth_scale->at_zero, depth.depth_scale->at_one, sample);
        return depth.depth_scale->kind == DepthScale::Kind::metres ? number : 1 / number;
    }
    if (kind_ == "inverse") return unit / sample;
    if (kind_ == "disparity") return 1 / between(disparity_range_[0], disparity_range_[1], sample);
    return unit * sample;
}

Image DepthOptions::raw_samples(const ImageFile& depth, const Image& picture, const Camera& camera,
                                bool& any_nothing) const {
    const Image stored = flip_ ? flipped(depth.image) : depth.image;
    Image result(stored.width, stored.height, 1);
    const double across = static_cast<double>(picture.width) / stored.width;
    const double up = static_cast<double>(picture.height) / stored.height;
    any_nothing = false;
    for (int y = 0; y < stored.height; ++y) {
        for (int x = 0; x < stored.width; ++x) {
            const float sample = stored.at(x, y, 0);
            float& raw = result.at(x, y, 0);
            const bool named = nothing_ && matches_sample(*nothing_, sample, depth.coding);
            any_nothing = any_nothing || named;
            raw = static_cast<float>(camera.sky_depth);
            if (named) continue;
            if (is_window()) {
                raw = sample;
                continue;
            }
            double z = metres(static_cast<double>(sample), depth);
            if (!(z > 0) || std::isinf(z)) continue;
            if (kind_ == "distance") {
                const auto [right, above] =
                    camera.view_plane((x + 0.5) * across, (y + 0.5) * up, picture.width, picture.height);
                if (!camera.orthographic) z /= std::sqrt(1 + right * right + above * above);
            }
            raw = static_cast<float>(camera.depth_at(z));
        }
    }
    return result;
}

DepthSamples DepthOptions::read(const std::string& name, const ImageFile& depth, const Image& picture,
                                const Camera& camera) const {
    const int width = depth.image.width, height = depth.image.height;
    if (!same_shape(depth.image, picture)) {
        throw Error(Place{.file = name}, fmt::format("is {}x{}, which is not the shape of the picture, {}x{}",
                                                     width, height, picture.width, picture.height));
    }
    expect_grey(name, depth);
    DepthSamples result;
    bool any_nothing = false;
    result.samples = raw_samples(depth, picture, camera, any_nothing);
    if (nothing_ && !any_nothing)
        result.remarks.push_back(fmt::format("no sample is {} (--depth-nothing)", *nothing_));
    if (width == picture.width && height == picture.height) return result;

    const std::string sizes =
        fmt::format("the depth is {}x{}, the picture {}x{}: ", width, height, picture.width, picture.height);
    if (width > picture.width || height > picture.height) {
        result.samples = nearest_values(result.samples, picture.width, picture.height);
        result.warnings.push_back(sizes + "each pixel takes the nearest sample");
    } else {
        const Image affine = converted(std::move(result.samples), camera, false);
        result.samples = converted(joint_bilateral(affine, picture), camera, true);
        result.warnings.push_back(sizes + "brought to its size along its edges");
    }
    return result;
}

} // namespace postfx::host
