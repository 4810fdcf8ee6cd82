// The thin lens of README.md in float64, from distances in metres, and sums of colours.
#pragma once

#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace postfx::testing {

inline constexpr double sharp = 1; ///< pixels
using Color = std::array<double, 3>;

/// Sum of colours with weights.
struct Mean {
    Color sum{};
    double weight = 0;
    void add(const Color& color, double w) {
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += w * color[c];
        weight += w;
    }
    bool any() const { return weight > 0; }
    Color value() const { return {sum[0] / weight, sum[1] / weight, sum[2] / weight}; }
};

inline Color color_at(const Image64& image, int x, int y) {
    Color color{};
    for (int c = 0; c < 3; ++c) {
        const double value = image.at(x, y, c);
        color[static_cast<std::size_t>(c)] = std::isnan(value) ? 0 : std::clamp(value, -65504.0, 65504.0);
    }
    return color;
}

/// What is sharp [m]: what the effect was told, else what the camera says, else 5.
inline double focus_of(const ReferenceInput& input) {
    for (double distance : {input.value("focus_distance"), input.camera.focus_distance}) {
        if (distance > 0) return distance;
    }
    return 5;
}

/// What axial aberration adds to the signed circle [px] of red, green and blue.
struct Axial {
    std::array<double, 3> shift{};
    double largest() const { return std::max(std::abs(shift[0]), std::abs(shift[2])); }
    bool any() const { return largest() > 0; }
};

/// The thin lens, from metres.
class Lens {
public:
    explicit Lens(const ReferenceInput& input)
        : camera_(input.camera), focus_(focus_of(input)),
          aperture_(input.value("focal_length") * 1e-3 / input.value("f_number")),
          height_(input.color.height), focal_length_(input.value("focal_length") * 1e-3),
          longer_red_(input.value("axial_aberration")) {
        const double near = std::abs(unlimited(camera_.near_plane));
        const double sky = std::abs(unlimited(std::numeric_limits<double>::infinity()));
        limit_ = std::min(input.value("max_circle_of_confusion") * height_, std::max(near, sky));
    }
    double limit() const { return limit_; }
    bool blurs() const { return limit_ > sharp && aperture_ > 0; }

    /// Signed diameter [px] of the circle for a raw depth sample.
    double circle(double depth) const {
        if (std::isnan(depth)) return 0;
        return std::clamp(unlimited(camera_.view_z(depth)), -limit_, limit_);
    }

    /// A lens of one glass: n = A + B / wavelength^2, the focal length proportional to 1 / (n - 1). What green
    /// focuses at S, a focal length longer by the share e focuses at S' with 1/S' = 1/S - e/f; circles differ by that
    /// in 1/z.
    Axial axial() const {
        const auto bending = [](double micrometres) { return 1 / (micrometres * micrometres); };
        const double height = camera_.orthographic
                                  ? camera_.vertical_extent / focus_
                                  : 2 * std::tan(camera_.vertical_fov * std::numbers::pi / 360);
        const double whole = std::min(longer_red_ * aperture_ / focal_length_ / height * height_, limit_);
        Axial result;
        const double share = whole / (bending(0.464) - bending(0.612));
        result.shift[0] = share * (bending(0.612) - bending(0.549));
        result.shift[2] = share * (bending(0.464) - bending(0.549));
        return result;
    }

private:
    double unlimited(double z) const {
        // Similar triangles between the lens, the focus plane and the point: the disc in the plane of focus
        // is A |z - S| / z wide seen through a point (perspective), A |z - S| / S at the point itself
        // (orthographic).
        if (camera_.orthographic)
            return aperture_ * (z - focus_) / focus_ * height_ / camera_.vertical_extent;
        const double in_focus_plane = std::isinf(z) ? aperture_ : aperture_ * (z - focus_) / z;
        const double plane_height = 2 * focus_ * std::tan(camera_.vertical_fov * std::numbers::pi / 360);
        return in_focus_plane / plane_height * height_;
    }

    Camera camera_;
    double focus_, aperture_, height_, focal_length_, longer_red_, limit_ = 0;
};

} // namespace postfx::testing
