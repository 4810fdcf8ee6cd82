// The model of README.md in float64, by brute force: distances in metres first, every pair of texels looked
// at.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using postfx::Camera;
using postfx::Image64;
using postfx::testing::ReferenceInput;

namespace {

constexpr double sharp = 1; ///< pixels
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

Color color_at(const Image64& image, int x, int y) {
    Color color{};
    for (int c = 0; c < 3; ++c) {
        const double value = image.at(x, y, c);
        color[static_cast<std::size_t>(c)] = std::isnan(value)   ? 0
                                             : std::isinf(value) ? std::copysign(65504, value)
                                                                 : value;
    }
    return color;
}

/// What is sharp [m]: what the effect was told, else what the camera says, else 5.
double focus_of(const ReferenceInput& input) {
    for (double distance : {input.value("focus_distance"), input.camera.focus_distance}) {
        if (distance > 0) return distance;
    }
    return 5;
}

/// The thin lens, from metres.
class Lens {
public:
    explicit Lens(const ReferenceInput& input)
        : camera_(input.camera), focus_(focus_of(input)),
          aperture_(input.value("focal_length") * 1e-3 / input.value("f_number")),
          height_(input.color.height) {
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
    double focus_, aperture_, height_, limit_ = 0;
};

/// A block of pixels: what it shows of the background and of the foreground.
struct Texel {
    Color behind{}, before{};
    bool behind_is_sharp = false, behind_is_blurred = false;
    double behind_radius = 0, before_radius = 0, coverage = 0;
};

struct Blurred {
    Color color{};
    enum Kind { unknown, in_focus, blurred } kind = unknown;
};

double disc(double radius, double distance) {
    const double inside = std::clamp(radius + 0.5 - distance, 0.0, 1.0);
    return inside / (std::numbers::pi * (radius * radius + 1.0 / 12));
}

class Model {
public:
    explicit Model(const ReferenceInput& input)
        : input_(input), lens_(input), block_(std::max(2, static_cast<int>(std::ceil(lens_.limit() / 12)))),
          width_((input.color.width + block_ - 1) / block_),
          height_((input.color.height + block_ - 1) / block_) {}

    Image64 picture() {
        if (!lens_.blurs()) return input_.color;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x)
                texels_.push_back(make_texel(x, y));
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const double reach = foreground_reach(x, y);
                background_.push_back(background(x, y, reach));
                foreground_.push_back(foreground(x, y, reach));
            }
        }
        Image64 result(input_.color.width, input_.color.height, 3);
        for (int y = 0; y < result.height; ++y) {
            for (int x = 0; x < result.width; ++x)
                compose(x, y, result.pixel(x, y));
        }
        return result;
    }

private:
    double circle(int x, int y) const { return lens_.circle(input_.attachments.at("depth").at(x, y, 0)); }
    /// Part of a pixel that the reduced layers show: from 0 at one pixel to 1 at a texel's radius.
    double blurred_part(double circle) const {
        return std::clamp((std::abs(circle) - sharp) / (2 * block_ - sharp), 0.0, 1.0);
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_)
               + static_cast<std::size_t>(std::clamp(x, 0, width_ - 1));
    }
    double texels(double diameter) const { return std::max(0.5, diameter / 2 / block_); }

    Texel make_texel(int tx, int ty) const {
        Mean sharp_mean, far_mean, near_mean;
        double far_circle = 0, near_circle = 0;
        for (int i = 0; i < block_ * block_; ++i) {
            const int x = std::min(tx * block_ + i % block_, input_.color.width - 1);
            const int y = std::min(ty * block_ + i / block_, input_.color.height - 1);
            const double c = circle(x, y);
            const double part = blurred_part(c);
            const Color light = color_at(input_.color, x, y);
            if (part == 0 || c < 0) sharp_mean.add(light, 1 - part);
            if (part > 0 && c > 0) far_mean.add(light, part), far_circle += part * c;
            if (part > 0 && c < 0) near_mean.add(light, part), near_circle -= part * c;
        }
        Texel texel;
        texel.behind_is_blurred = far_mean.any();
        texel.behind_is_sharp = !far_mean.any() && sharp_mean.any();
        if (texel.behind_is_sharp) texel.behind = sharp_mean.value();
        if (texel.behind_is_blurred) {
            texel.behind = far_mean.value();
            texel.behind_radius = texels(far_circle / far_mean.weight);
        }
        if (near_mean.any()) {
            texel.before = near_mean.value();
            texel.before_radius = texels(near_circle / near_mean.weight);
            texel.coverage = near_mean.weight / (block_ * block_);
        }
        return texel;
    }

    /// Largest radius in the 8x8 tile and the tiles around it.
    double foreground_reach(int tx, int ty) const {
        double radius = 0;
        const int first_x = (tx / 8 - 1) * 8, first_y = (ty / 8 - 1) * 8;
        for (int y = std::max(0, first_y); y < std::min(height_, first_y + 24); ++y) {
            for (int x = std::max(0, first_x); x < std::min(width_, first_x + 24); ++x)
                radius = std::max(radius, texels_[index(x, y)].before_radius);
        }
        return radius;
    }

    template<class Visit>
    void around(int tx, int ty, Visit visit) const {
        for (int y = -7; y <= 7; ++y) {
            for (int x = -7; x <= 7; ++x)
                visit(texels_[index(tx + x, ty + y)], std::hypot(x, y));
        }
    }

    Blurred background(int tx, int ty, double reach) const {
        const Texel& own = texels_[index(tx, ty)];
        if (own.behind_is_sharp) return {own.behind, Blurred::in_focus};
        Mean mean;
        around(tx, ty, [&](const Texel& other, double distance) {
            if (own.behind_is_blurred) {
                if (!other.behind_is_blurred) return;
                mean.add(other.behind, disc(std::min(own.behind_radius, other.behind_radius), distance));
            } else if (other.behind_is_blurred || other.behind_is_sharp) {
                mean.add(other.behind, std::clamp(reach + 0.5 - distance, 0.0, 1.0));
            }
        });
        return mean.any() ? Blurred{mean.value(), Blurred::blurred} : Blurred{};
    }

    /// Colour times coverage, coverage.
    Mean foreground(int tx, int ty, double reach) const {
        Mean mean;
        if (reach == 0) return mean;
        around(tx, ty, [&](const Texel& other, double distance) {
            if (other.coverage > 0)
                mean.add(other.before, other.coverage * disc(other.before_radius, distance));
        });
        if (mean.weight > 1) mean = Mean{mean.value(), 1};
        return mean;
    }

    void compose(int px, int py, double* result) const {
        const double c = circle(px, py);
        const double part = blurred_part(c);
        const double u = (px + 0.5) / block_ - 0.5, v = (py + 0.5) / block_ - 0.5;
        const int left = static_cast<int>(std::floor(u)), bottom = static_cast<int>(std::floor(v));
        Mean over, under;
        for (int y = bottom; y <= bottom + 1; ++y) {
            for (int x = left; x <= left + 1; ++x) {
                const double weight = (1 - std::abs(x - u)) * (1 - std::abs(y - v));
                const Mean& before = foreground_[index(x, y)];
                if (before.any()) over.add(before.value(), weight * before.weight);
                const Blurred& behind = background_[index(x, y)];
                const bool usable =
                    behind.kind == Blurred::blurred || (c < 0 && behind.kind == Blurred::in_focus);
                if (usable) under.add(behind.color, weight);
            }
        }
        if (part == 0 && !over.any()) {
            std::copy_n(input_.color.pixel(px, py), 3, result);
            return;
        }
        const double covered = over.weight;
        const double missing = c < 0 ? std::max(0.0, part - covered) : 0;
        const Color own = color_at(input_.color, px, py);
        const Color beyond = under.any() ? under.value() : over.any() ? over.value() : own;
        for (std::size_t i = 0; i < 3; ++i) {
            const double base = c > 0 ? (1 - part) * own[i] + part * beyond[i] : own[i];
            const double rest = 1 - std::max(c < 0 ? part : 0.0, covered);
            result[i] = over.sum[i] + missing * beyond[i] + rest * base;
        }
    }

    const ReferenceInput& input_;
    Lens lens_;
    int block_, width_, height_;
    std::vector<Texel> texels_;
    std::vector<Blurred> background_;
    std::vector<Mean> foreground_;
};

/// Diameters in pixels: before the focus plane in red, behind it in blue.
Image64 circles(const ReferenceInput& input) {
    const Lens lens(input);
    Image64 result(input.color.width, input.color.height, 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const double circle = lens.circle(input.attachments.at("depth").at(x, y, 0));
            result.at(x, y, 0) = std::max(0.0, -circle);
            result.at(x, y, 2) = std::max(0.0, circle);
        }
    }
    return result;
}

} // namespace

Image64 postfx::testing::reference(const ReferenceInput& input) {
    if (input.value("view") == 1) return circles(input);
    return Model(input).picture();
}
