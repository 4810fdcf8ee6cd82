// The model of README.md in float64, by brute force: every pair of texels looked at.
#include "reference_lens.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using namespace postfx::testing;
using postfx::Image64;

namespace {

/// Of a level that blurs layers of blocks.
struct Layers {
    int largest_radius, finest_block, block_step, tile;
    double softening; ///< of discs' edges, for a pixel more in a block
};

Layers layers_of(const std::string& level) {
    if (level == "low") return {4, 2, 2, 8, 0};
    if (level == "medium") return {7, 2, 1, 16, 0.25};
    if (level == "ultra") return {14, 1, 1, 16, 0.25};
    return {40, 1, 1, 48, 0.25};
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

class Model {
public:
    explicit Model(const ReferenceInput& input)
        : input_(input), lens_(input), layers_(layers_of(input.level)), axial_(lens_.axial()),
          block_(block_of(input.color.height)), width_((input.color.width + block_ - 1) / block_),
          height_((input.color.height + block_ - 1) / block_) {}

    Image64 picture() {
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x)
                texels_.push_back(make_texel(x, y));
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                foreground_.push_back(foreground(x, y));
                background_.push_back(background(x, y));
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
    /// Texels over which a disc's edge falls.
    double edge() const { return 1 + layers_.softening * std::min(block_ - 1, 2); }
    /// Part of a disc's weight at that distance: a line through 1/2 at the radius.
    double disc(double radius, double distance) const {
        return std::clamp((radius - distance) / edge() + 0.5, 0.0, 1.0);
    }
    /// Part of a pixel that the reduced layers show: from 0 at one pixel to 1 where the gathered disc is a texel.
    double blurred_part(double circle) const {
        const double variance = std::max(other_variance() + 1.0 / 16, 0.0);
        const double all_blurred = std::max(block_ * 4 * std::sqrt(variance), sharp + 0.5);
        return std::clamp((std::abs(circle) - sharp) / (all_blurred - sharp), 0.0, 1.0);
    }
    /// Of all that spreads light but the discs, texels^2 an axis; less what a pixel's square seen by a pixel does.
    double other_variance() const {
        double places = 0, interpolation = 0; // pixels^2
        for (int i = 0; i < block_; ++i)
            places += std::pow(i - (block_ - 1) / 2.0, 2) / block_;
        for (int i = -2 * block_; i < 2 * block_; ++i) {
            const double distance = i + (block_ % 2 == 0 ? 0.5 : 0.0);
            interpolation += std::pow(distance, 2) * std::max(0.0, 1 - std::abs(distance) / block_) / block_;
        }
        // A soft edge is a mean of discs of the radii within it, by their area: r^4 / 4 over r^2, if it is short.
        const double soft_edge = 5 * edge() * edge() / 48;
        return (places + interpolation - 1.0 / 6) / (block_ * block_) + soft_edge;
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_)
               + static_cast<std::size_t>(std::clamp(x, 0, width_ - 1));
    }
    /// Radius of a disc of texels that together with all other spreading has the circle's variance, r^2/4 an axis.
    double texels(double diameter) const {
        const double variance = std::pow(diameter / block_, 2) / 16 - other_variance();
        return variance > 1.0 / 16 ? 2 * std::sqrt(variance) : 0.5;
    }
    /// The disc of a colour that has another circle than the one that disc is of.
    double shifted(double radius, double change) const {
        const double diameter = 4 * block_ * std::sqrt(std::max(radius * radius / 4 + other_variance(), 0.0));
        return texels(std::max(diameter + change, 0.0));
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
            texel.behind_radius = texels(far_circle / far_mean.weight);
        }
        if (near_mean.any()) {
            texel.before = near_mean.value();
            texel.before_radius = texels(near_circle / near_mean.weight);
            texel.coverage = near_mean.weight / (block_ * block_);
            texel.thickness = texel.coverage / table_of_discs(texel.before_radius);
        }
        return texel;
    }

    /// Largest radius of foreground in the tile and the tiles around it.
    double reach(int tx, int ty) const {
        const int tile = layers_.tile;
        double near = 0;
        const int first_x = (tx / tile - 1) * tile, first_y = (ty / tile - 1) * tile;
        for (int y = std::max(0, first_y); y < std::min(height_, first_y + 3 * tile); ++y) {
            for (int x = std::max(0, first_x); x < std::min(width_, first_x + 3 * tile); ++x)
                near = std::max(near, texels_[index(x, y)].before_radius);
        }
        return near;
    }

    template<class Visit>
    void around(int tx, int ty, Visit visit) const {
        // Axial aberration lets the smallest discs grow by more than half their circle.
        const int far = layers_.largest_radius + 3;
        for (int y = -far; y <= far; ++y) {
            for (int x = -far; x <= far; ++x) {
                visit(texels_[index(tx + x, ty + y)], std::hypot(x, y));
            }
        }
    }

    Blurred background(int tx, int ty) const {
        const Texel& own = texels_[index(tx, ty)];
        if (own.behind_is_sharp) return {own.behind, Blurred::in_focus};
        if (!own.behind_is_blurred) return behind_foreground(tx, ty, reach(tx, ty));
        const double radius = own.behind_radius;
        Blurred result{{}, Blurred::blurred};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            // 0 for surfaces as far as this one, 1 for clearly farther ones, which show past its edge.
            const auto farther = [&](const Texel& other) {
                return std::clamp(4 * other.behind_radius / radius - 5, 0.0, 1.0);
            };
            const auto weight = [&](double r, double distance) {
                if (axial_.shift[channel] != 0) r = shifted(r, axial_.shift[channel]);
                return disc(r, distance) / (r * r);
            };
            Mean mean, past;
            double past_weight = 0;
            around(tx, ty, [&](const Texel& other, double distance) {
                if (!other.behind_is_blurred) return;
                const double w = weight(std::min(radius, other.behind_radius), distance);
                mean.add(other.behind, w * (1 - farther(other)));
                past_weight += w * farther(other);
            });
            if (past_weight > 0) {
                around(tx, ty, [&](const Texel& other, double distance) {
                    if (other.behind_is_blurred)
                        past.add(other.behind, farther(other) * weight(other.behind_radius, distance));
                });
                mean.add(past.value(), past_weight);
            }
            result.color[channel] = mean.value()[channel];
        }
        return result;
    }

    /// A hole: what background is near, or the foreground of the smallest circles if none is.
    Blurred behind_foreground(int tx, int ty, double reach) const {
        Mean mean;
        if (foreground_[index(tx, ty)].weight >= 0.98) return {};
        around(tx, ty, [&](const Texel& other, double distance) {
            if (other.behind_is_blurred || other.behind_is_sharp)
                mean.add(other.behind, disc(reach, distance));
        });
        if (!mean.any()) {
            const double extent = std::floor(reach);
            around(tx, ty, [&](const Texel& other, double distance) {
                if (other.coverage > 0 && distance <= extent)
                    mean.add(other.before, std::pow(other.before_radius, -8));
            });
        }
        if (!mean.any()) return {};
        return {mean.value(), Blurred::blurred};
    }

    double weights_of_disc(double radius) const {
        const int reach = static_cast<int>(radius) + 1;
        double sum = 0;
        for (int y = -reach; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x)
                sum += disc(radius, std::hypot(x, y));
        }
        return sum;
    }
    /// As the model has it: a straight line between each two of 1024 radii.
    double table_of_discs(double radius) const {
        const double spacing = (layers_.largest_radius + 0.1 - 0.5) / 1023;
        const double below = std::min(std::floor((radius - 0.5) / spacing), 1022.0);
        const double part = (radius - 0.5) / spacing - below;
        return (1 - part) * weights_of_disc(0.5 + below * spacing)
               + part * weights_of_disc(0.5 + (below + 1) * spacing);
    }

    /// Colour times coverage, coverage. Of overlapping surfaces those nearer than the mean count first.
    Mean foreground(int tx, int ty) const {
        Mean all;
        double radii = 0;
        around(tx, ty, [&](const Texel& other, double distance) {
            if (other.coverage == 0) return;
            const double w = other.thickness * disc(other.before_radius, distance);
            all.add(other.before, w);
            radii += w * other.before_radius;
        });
        if (!all.any()) return {};
        const auto nearness = [&](const Texel& other) {
            return std::clamp(2 * other.before_radius / (radii / all.weight) - 1.5, 0.0, 1.0);
        };
        double near = 0;
        around(tx, ty, [&](const Texel& other, double distance) {
            if (other.coverage > 0)
                near += nearness(other) * other.thickness * disc(other.before_radius, distance);
        });
        const double ordered = std::clamp((all.weight - 1.01) / 0.04, 0.0, 1.0);
        const double plain = 1 / std::max(1.0, all.weight);
        const double far = all.weight - near;
        const double near_part = (1 - ordered) * plain + ordered / std::max(1.0, near);
        const double far_part =
            (1 - ordered) * plain + (ordered > 0 ? ordered * std::max(0.0, 1 - near) / far : 0);
        Mean mean;
        std::array<Mean, 3> colors;
        around(tx, ty, [&](const Texel& other, double distance) {
            if (other.coverage == 0) return;
            const double part = nearness(other) * near_part + (1 - nearness(other)) * far_part;
            mean.add(other.before, part * other.thickness * disc(other.before_radius, distance));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double change = -axial_.shift[channel];
                const double r = change == 0 ? other.before_radius : shifted(other.before_radius, change);
                colors[channel].add(other.before, part * other.thickness * disc(r, distance) / (r * r));
            }
        });
        for (std::size_t channel = 0; channel < 3; ++channel) {
            if (axial_.any() && colors[channel].any())
                mean.sum[channel] = colors[channel].value()[channel] * mean.weight;
        }
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
        int block = std::max(fitting, rows >= 720 ? layers_.finest_block : 1);
        while (block > 1 && block % layers_.block_step != 0)
            ++block;
        return block;
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
    if (input.level == "classic") return squares(input);
    return Model(input).picture();
}
