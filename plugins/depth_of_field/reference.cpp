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

/// Of a level that blurs layers of blocks.
struct Layers {
    int largest_radius, finest_block;
    int far_lattice, near_lattice; ///< one texel of so many is visited
};

Layers layers_of(double quality) {
    if (quality == 0) return {3, 2, 2, 2};
    if (quality == 1) return {6, 2, 2, 4};
    if (quality == 2) return {6, 2, 1, 1};
    return {12, 1, 2, 2};
}

/// A block of pixels: what it shows of the background and of the foreground.
struct Texel {
    Color behind{}, before{};
    bool behind_is_sharp = false, behind_is_blurred = false;
    double behind_radius = 0, before_radius = 0, coverage = 0, thickness = 0;
};

struct Blurred {
    Color color{};
    enum Kind { unknown, in_focus, blurred } kind = unknown;
};

/// Part of a disc's weight at that distance: between 0 and 1 where the square is within `radius` of the disc's.
double disc(double radius, double distance) {
    return std::clamp((radius * radius + radius - distance * distance) / (2 * radius), 0.0, 1.0);
}

class Model {
public:
    explicit Model(const ReferenceInput& input)
        : input_(input), lens_(input), layers_(layers_of(input.value("quality"))), axial_(lens_.axial()),
          block_(block_of(input.color.height)), width_((input.color.width + block_ - 1) / block_),
          height_((input.color.height + block_ - 1) / block_) {}

    Image64 picture() {
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x)
                texels_.push_back(make_texel(x, y));
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const double reach = foreground_reach(x, y);
                background_.push_back(background(x, y, reach));
                foreground_.push_back(foreground(x, y));
            }
        }
        if (layers_.far_lattice > 1) join_lattice();
        Image64 result(input_.color.width, input_.color.height, 3);
        for (int y = 0; y < result.height; ++y) {
            for (int x = 0; x < result.width; ++x)
                compose(x, y, result.pixel(x, y));
        }
        return result;
    }

private:
    double circle(int x, int y) const { return lens_.circle(input_.attachments.at("depth").at(x, y, 0)); }
    /// Part of a pixel that the reduced layers show: from 0 at one pixel to 1 where the gathered disc is a texel.
    double blurred_part(double circle) const {
        const double variance = other_variance(circle > 0 ? layers_.far_lattice : layers_.near_lattice);
        const double all_blurred = block_ * 4 * std::sqrt(variance + 1.0 / 16);
        return std::clamp((std::abs(circle) - sharp) / (all_blurred - sharp), 0.0, 1.0);
    }
    /// Of all that spreads light but the discs, texels^2 an axis.
    static double other_variance(int lattice) { return lattice == 1 ? 0.25 : 0.75; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_)
               + static_cast<std::size_t>(std::clamp(x, 0, width_ - 1));
    }
    /// Radius of a disc of texels that together with all other spreading has the circle's variance, r^2/4 an axis.
    double texels(double diameter, int lattice) const {
        const double variance = std::pow(diameter / block_, 2) / 16 - other_variance(lattice);
        return variance > 1.0 / 16 ? 2 * std::sqrt(variance) : 0.5;
    }
    static bool visits(int lattice, int x, int y) {
        return lattice == 1 || (lattice == 2 ? (x + y) % 2 == 0 : y % 2 == 0 && (x + y / 2) % 2 == 0);
    }

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
            texel.behind_radius = texels(far_circle / far_mean.weight, layers_.far_lattice);
        }
        if (near_mean.any()) {
            texel.before = near_mean.value();
            texel.before_radius = texels(near_circle / near_mean.weight, layers_.near_lattice);
            texel.coverage = near_mean.weight / (block_ * block_);
            texel.thickness = texel.coverage / table_of_discs(texel.before_radius);
        }
        return texel;
    }

    /// Largest radius of foreground in the tile and the tiles around it; 0 if no background is seen in them.
    double foreground_reach(int tx, int ty) const {
        const int tile = layers_.largest_radius <= 6 ? 8 : 16;
        double radius = 0;
        const int first_x = (tx / tile - 1) * tile, first_y = (ty / tile - 1) * tile;
        for (int y = std::max(0, first_y); y < std::min(height_, first_y + 3 * tile); ++y) {
            for (int x = std::max(0, first_x); x < std::min(width_, first_x + 3 * tile); ++x)
                radius = std::max(radius, texels_[index(x, y)].before_radius);
        }
        return radius;
    }

    template<class Visit>
    void around(int tx, int ty, int lattice, Visit visit) const {
        const int far = layers_.largest_radius + 1;
        for (int y = -far; y <= far; ++y) {
            for (int x = -far; x <= far; ++x) {
                if (visits(lattice, x, y)) visit(texels_[index(tx + x, ty + y)], std::hypot(x, y));
            }
        }
    }

    Blurred background(int tx, int ty, double reach) const {
        const Texel& own = texels_[index(tx, ty)];
        if (own.behind_is_sharp) return {own.behind, Blurred::in_focus};
        const double radius = own.behind_is_blurred ? own.behind_radius : reach;
        Blurred result{{}, Blurred::blurred};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            Mean mean;
            around(tx, ty, layers_.far_lattice, [&](const Texel& other, double distance) {
                if (own.behind_is_blurred && other.behind_is_blurred) {
                    const double shift = axial_.shift[channel] / 2 / block_;
                    const double r = std::max(0.5, std::min(radius, other.behind_radius) + shift);
                    mean.add(other.behind, disc(r, distance) / (r * r));
                } else if (!own.behind_is_blurred && (other.behind_is_blurred || other.behind_is_sharp)) {
                    mean.add(other.behind, disc(radius, distance));
                }
            });
            if (!mean.any()) return {};
            result.color[channel] = mean.value()[channel];
        }
        return result;
    }

    double weights_of_disc(double radius) const {
        double sum = 0;
        for (int y = -13; y <= 13; ++y) {
            for (int x = -13; x <= 13; ++x)
                sum += visits(layers_.near_lattice, x, y) ? disc(radius, std::hypot(x, y)) : 0;
        }
        return sum;
    }
    /// As the model has it: a straight line between each two of 256 radii.
    double table_of_discs(double radius) const {
        const double spacing = (layers_.largest_radius - 0.5) / 255;
        const double below = std::min(std::floor((radius - 0.5) / spacing), 254.0);
        const double part = (radius - 0.5) / spacing - below;
        return (1 - part) * weights_of_disc(0.5 + below * spacing)
               + part * weights_of_disc(0.5 + (below + 1) * spacing);
    }

    /// Colour times coverage, coverage.
    Mean foreground(int tx, int ty) const {
        Mean mean;
        std::array<Mean, 3> colors;
        around(tx, ty, layers_.near_lattice, [&](const Texel& other, double distance) {
            if (other.coverage == 0) return;
            mean.add(other.before, other.thickness * disc(other.before_radius, distance));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double r = std::max(0.5, other.before_radius - axial_.shift[channel] / 2 / block_);
                colors[channel].add(other.before, other.thickness * disc(r, distance) / (r * r));
            }
        });
        for (std::size_t channel = 0; channel < 3; ++channel) {
            if (axial_.any() && colors[channel].any())
                mean.sum[channel] = colors[channel].value()[channel] * mean.weight;
        }
        if (mean.weight > 1) mean = Mean{mean.value(), 1};
        return mean;
    }

    /// What a texel could not see of the lattice, its neighbours did.
    void join_lattice() {
        const std::vector<Blurred> background = background_;
        const std::vector<Mean> foreground = foreground_;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                Mean behind, before;
                for (int i = 0; i < 9; ++i) {
                    const int dx = i % 3 - 1, dy = i / 3 - 1;
                    const double tent = (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0;
                    const Blurred& other = background[index(x + dx, y + dy)];
                    if (other.kind == Blurred::blurred) behind.add(other.color, tent);
                    const Mean& neighbour = foreground[index(x + dx, y + dy)];
                    if (neighbour.any()) before.add(neighbour.value(), neighbour.weight * tent);
                }
                Blurred& own = background_[index(x, y)];
                if (own.kind == Blurred::blurred) own.color = behind.value();
                foreground_[index(x, y)] = before;
            }
        }
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
                // What is in focus shows behind foreground where nothing blurred does.
                if (behind.kind != Blurred::unknown)
                    under.add(behind.color, behind.kind == Blurred::blurred ? weight : weight / 65536);
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
    Layers layers_;
    Axial axial_;
    /// Pixels: so many that the largest circle fits, and no fewer than the level has from 720 rows on.
    int block_of(int rows) const {
        const double largest = (lens_.limit() + axial_.largest()) / 2;
        const int fitting = static_cast<int>(std::ceil(largest / layers_.largest_radius));
        return std::max(fitting, rows >= 720 ? layers_.finest_block : 1);
    }

    int block_, width_, height_;
    std::vector<Texel> texels_;
    std::vector<Blurred> background_;
    std::vector<Mean> foreground_;
};

/// Every pixel's circle, signed.
std::vector<double> all_circles(const ReferenceInput& input, const Lens& lens) {
    std::vector<double> circles;
    for (int y = 0; y < input.color.height; ++y) {
        for (int x = 0; x < input.color.width; ++x)
            circles.push_back(lens.circle(input.attachments.at("depth").at(x, y, 0)));
    }
    return circles;
}

/// The level reference: each point of the lens looks along its own line.
class LensPoints {
public:
    explicit LensPoints(const ReferenceInput& input)
        : input_(input), lens_(input), axial_(lens_.axial()), circles_(all_circles(input, lens_)) {}

    Image64 picture() const {
        const int count = static_cast<int>(input_.value("lens_samples"));
        Image64 result(input_.color.width, input_.color.height, 3);
        for (int y = 0; y < result.height; ++y) {
            for (int x = 0; x < result.width; ++x) {
                Color sum{};
                bool alone = true;
                for (int i = 0; i < count; ++i) {
                    const double turn = std::fmod(i * double(2654435769u), 4294967296.0) / 4294967296.0;
                    const double distance = std::sqrt((i + 0.5) / count);
                    const double px = distance * std::cos(2 * std::numbers::pi * turn);
                    const double py = distance * std::sin(2 * std::numbers::pi * turn);
                    for (std::size_t channel = 0; channel < 3; ++channel) {
                        const auto [qx, qy] = seen(x, y, px, py, axial_.shift[channel]);
                        sum[channel] += color_at(input_.color, qx, qy)[channel] / count;
                        alone = alone && qx == x && qy == y;
                    }
                }
                if (alone)
                    std::copy_n(input_.color.pixel(x, y), 3, result.pixel(x, y));
                else
                    std::copy_n(sum.begin(), 3, result.pixel(x, y));
            }
        }
        return result;
    }

private:
    using Place = std::pair<int, int>;

    Place held(double x, double y) const {
        return {static_cast<int>(std::clamp(x, 0.0, input_.color.width - 1.0)),
                static_cast<int>(std::clamp(y, 0.0, input_.color.height - 1.0))};
    }
    double circle(const Place& at) const {
        return circles_[static_cast<std::size_t>(at.second) * static_cast<std::size_t>(input_.color.width)
                        + static_cast<std::size_t>(at.first)];
    }

    Place seen(int x, int y, double px, double py, double shift) const {
        const double longer = std::max(std::abs(px), std::abs(py));
        const auto step_of = [&](const Place& at) { return (circle(at) + shift) / 2 * longer; };
        const int steps = static_cast<int>(std::floor((lens_.limit() + std::abs(shift)) / 2 * longer + 0.5));
        std::vector<Place> in_front; // what the line passed before it went behind something
        bool was_in_front = false;
        Place last{x, y};
        for (int k = -steps; k <= steps; ++k) {
            const Place at =
                held(std::floor(x - k * px / longer + 0.5), std::floor(y - k * py / longer + 0.5));
            const double beyond = step_of(at) - k;
            if (std::abs(beyond) <= 0.5) {
                const double c = circle(at) + shift;
                const Place own = held(x - std::floor(c / 2 * px + 0.5), y - std::floor(c / 2 * py + 0.5));
                return std::abs(step_of(own) - k) <= 0.5 ? own : at;
            }
            if (beyond < 0 && was_in_front) in_front.push_back(last);
            was_in_front = beyond > 0;
            last = at;
        }
        return in_front.empty() ? Place{x, y} : in_front.front();
    }

    const ReferenceInput& input_;
    Lens lens_;
    Axial axial_;
    std::vector<double> circles_;
};

/// The level classic: the mean of the square that a pixel's own circle gives.
Image64 squares(const ReferenceInput& input) {
    const Lens lens(input);
    const std::vector<double> circles = all_circles(input, lens);
    Image64 result = input.color;
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const double c = circles[static_cast<std::size_t>(y) * static_cast<std::size_t>(result.width)
                                     + static_cast<std::size_t>(x)];
            const int radius = static_cast<int>(std::abs(c) / 2);
            if (radius == 0) continue;
            Mean mean;
            for (int v = y - radius; v <= y + radius; ++v) {
                for (int u = x - radius; u <= x + radius; ++u)
                    mean.add(color_at(input.color, std::clamp(u, 0, result.width - 1),
                                      std::clamp(v, 0, result.height - 1)),
                             1);
            }
            std::ranges::copy(mean.value(), result.pixel(x, y));
        }
    }
    return result;
}

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
    if (!Lens(input).blurs()) return input.color;
    if (input.value("quality") == 4) return LensPoints(input).picture();
    if (input.value("quality") == 5) return squares(input);
    return Model(input).picture();
}
