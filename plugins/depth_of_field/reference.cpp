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
    int largest_radius, finest_block, block_step;
    double thin_from, thinnest_from; ///< radii of the background from which one texel of 2, of 4 is visited
    int near_lattice;                ///< one texel of so many is visited
    int tile;

    int far_lattice(double radius) const { return radius < thin_from ? 1 : radius < thinnest_from ? 2 : 4; }
};

Layers layers_of(const std::string& level) {
    if (level == "low") return {4, 2, 2, 9, 9, 1, 8};
    if (level == "medium") return {7, 2, 2, 4, 5, 4, 16};
    if (level == "high") return {7, 2, 2, 9, 9, 1, 16};
    if (level == "ultra") return {14, 1, 1, 0, 7, 4, 16};
    return {40, 1, 1, 99, 99, 1, 48};
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
    int lattice = 1;
};

/// Part of a disc's weight at that distance: between 0 and 1 where the square is within `radius` of the disc's.
double disc(double radius, double distance) {
    return std::clamp((radius * radius + radius - distance * distance) / (2 * radius), 0.0, 1.0);
}

class Model {
public:
    explicit Model(const ReferenceInput& input)
        : input_(input), lens_(input), layers_(layers_of(input.level)), axial_(lens_.axial()),
          block_(block_of(input.color.height)), width_((input.color.width + block_ - 1) / block_),
          height_((input.color.height + block_ - 1) / block_) {
        // A level has no lattice for discs that its pictures can't have.
        const bool small_discs = input.level == "ultra" && radius_in_texels(lens_.limit()) <= 7;
        if (small_discs || radius_in_texels(lens_.behind_limit()) < layers_.thin_from)
            layers_.thin_from = layers_.thinnest_from = 99;
        if (small_discs) layers_.near_lattice = 1;
    }

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
        join_lattices();
        Image64 result(input_.color.width, input_.color.height, 3);
        for (int y = 0; y < result.height; ++y) {
            for (int x = 0; x < result.width; ++x)
                compose(x, y, result.pixel(x, y));
        }
        return result;
    }

private:
    double circle(int x, int y) const { return lens_.circle(input_.attachments.at("depth").at(x, y, 0)); }
    double radius_in_texels(double circle) const { return (circle + axial_.largest()) / 2 / block_; }
    /// Part of a pixel that the reduced layers show: from 0 at one pixel to 1 where the gathered disc is a texel.
    double blurred_part(double circle) const {
        const int lattice = circle > 0 ? layers_.far_lattice(0.5) : layers_.near_lattice;
        const double variance = std::max(other_variance(lattice) + 1.0 / 16, 0.0);
        const double all_blurred = std::max(block_ * 4 * std::sqrt(variance), sharp + 0.5);
        return std::clamp((std::abs(circle) - sharp) / (all_blurred - sharp), 0.0, 1.0);
    }
    /// Of all that spreads light but the discs, texels^2 an axis; less what a pixel's square seen by a pixel does.
    double other_variance(int lattice) const {
        double places = 0, interpolation = 0; // pixels^2
        for (int i = 0; i < block_; ++i)
            places += std::pow(i - (block_ - 1) / 2.0, 2) / block_;
        for (int i = -2 * block_; i < 2 * block_; ++i) {
            const double distance = i + (block_ % 2 == 0 ? 0.5 : 0.0);
            interpolation += std::pow(distance, 2) * std::max(0.0, 1 - std::abs(distance) / block_) / block_;
        }
        const double neighbours = lattice == 1   ? 0
                                  : lattice == 2 ? 4 * 0.125 / 2
                                                 : 4 * 0.125 / 2 + 4 * 0.0625;
        return (places + interpolation - 1.0 / 6) / (block_ * block_) + 1.0 / 12 + neighbours;
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_)
               + static_cast<std::size_t>(std::clamp(x, 0, width_ - 1));
    }
    /// Radius of a disc of texels that together with all other spreading has the circle's variance, r^2/4 an axis.
    double texels(double diameter, int lattice) const {
        const double variance = std::pow(diameter / block_, 2) / 16 - other_variance(lattice);
        return variance > 1.0 / 16 ? 2 * std::sqrt(variance) : 0.5;
    }
    /// Thinner lattices spread more: the widest disc that does with the lattice it is gathered from.
    double far_texels(double diameter) const {
        const double all = texels(diameter, 1), half = texels(diameter, 2), quarter = texels(diameter, 4);
        if (all < layers_.thin_from) return all;
        if (half < layers_.thinnest_from) return std::max(half, layers_.thin_from);
        return std::max(quarter, layers_.thinnest_from);
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
            texel.behind_radius = far_texels(far_circle / far_mean.weight);
        }
        if (near_mean.any()) {
            texel.before = near_mean.value();
            texel.before_radius = texels(near_circle / near_mean.weight, layers_.near_lattice);
            texel.coverage = near_mean.weight / (block_ * block_);
            texel.thickness = texel.coverage / table_of_discs(texel.before_radius);
        }
        return texel;
    }

    /// Largest radius in the tile and the tiles around it: of foreground, of background.
    std::pair<double, double> reach(int tx, int ty) const {
        const int tile = layers_.tile;
        double near = 0, far = 0;
        const int first_x = (tx / tile - 1) * tile, first_y = (ty / tile - 1) * tile;
        for (int y = std::max(0, first_y); y < std::min(height_, first_y + 3 * tile); ++y) {
            for (int x = std::max(0, first_x); x < std::min(width_, first_x + 3 * tile); ++x) {
                near = std::max(near, texels_[index(x, y)].before_radius);
                far = std::max(far, texels_[index(x, y)].behind_radius);
            }
        }
        return {near, far};
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

    Blurred background(int tx, int ty) const {
        const Texel& own = texels_[index(tx, ty)];
        if (own.behind_is_sharp) return {own.behind, Blurred::in_focus};
        const auto [near_reach, far_reach] = reach(tx, ty);
        if (!own.behind_is_blurred) return behind_foreground(tx, ty, near_reach);
        const double radius = own.behind_radius;
        Blurred result{{}, Blurred::blurred, layers_.far_lattice(radius)};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double shift = axial_.shift[channel] / 2 / block_;
            // 0 for surfaces as far as this one, 1 for clearly farther ones, which show past its edge.
            const auto farther = [&](const Texel& other) {
                return std::clamp(4 * other.behind_radius / radius - 5, 0.0, 1.0);
            };
            const auto weight = [&](double r, double distance) {
                r = std::max(0.5, r + shift);
                return disc(r, distance) / (r * r);
            };
            Mean mean, past;
            double past_weight = 0;
            around(tx, ty, result.lattice, [&](const Texel& other, double distance) {
                if (!other.behind_is_blurred) return;
                const double w = weight(std::min(radius, other.behind_radius), distance);
                mean.add(other.behind, w * (1 - farther(other)));
                past_weight += w * farther(other);
            });
            if (past_weight > 0) {
                around(tx, ty, layers_.far_lattice(far_reach + axial_.largest() / 2 / block_),
                       [&](const Texel& other, double distance) {
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
        int lattice = layers_.far_lattice(reach);
        around(tx, ty, lattice, [&](const Texel& other, double distance) {
            if (other.behind_is_blurred || other.behind_is_sharp)
                mean.add(other.behind, disc(reach, distance));
        });
        if (!mean.any() && foreground_[index(tx, ty)].weight < 0.98) {
            const double extent = std::floor(reach);
            lattice = layers_.far_lattice(extent);
            around(tx, ty, lattice, [&](const Texel& other, double distance) {
                if (other.coverage > 0 && distance <= extent)
                    mean.add(other.before, std::pow(other.before_radius, -8));
            });
        }
        if (!mean.any()) return {};
        return {mean.value(), Blurred::blurred, lattice};
    }

    double weights_of_disc(double radius) const {
        const int reach = static_cast<int>(radius) + 1;
        double sum = 0;
        for (int y = -reach; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x)
                sum += visits(layers_.near_lattice, x, y) ? disc(radius, std::hypot(x, y)) : 0;
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
        around(tx, ty, layers_.near_lattice, [&](const Texel& other, double distance) {
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
        around(tx, ty, layers_.near_lattice, [&](const Texel& other, double distance) {
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
        around(tx, ty, layers_.near_lattice, [&](const Texel& other, double distance) {
            if (other.coverage == 0) return;
            const double part = nearness(other) * near_part + (1 - nearness(other)) * far_part;
            mean.add(other.before, part * other.thickness * disc(other.before_radius, distance));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double r = std::max(0.5, other.before_radius - axial_.shift[channel] / 2 / block_);
                colors[channel].add(other.before, part * other.thickness * disc(r, distance) / (r * r));
            }
        });
        for (std::size_t channel = 0; channel < 3; ++channel) {
            if (axial_.any() && colors[channel].any())
                mean.sum[channel] = colors[channel].value()[channel] * mean.weight;
        }
        return mean;
    }

    /// The share of a neighbour, or of a texel itself, that makes the parts of a lattice equal.
    static double share(int lattice, int dx, int dy) {
        if (lattice == 1) return dx == 0 && dy == 0 ? 1 : 0;
        if (lattice == 2) return dx == 0 && dy == 0 ? 0.5 : std::abs(dx) + std::abs(dy) == 1 ? 0.125 : 0;
        return (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0;
    }
    /// What a texel could not see of the lattice, its neighbours did.
    void join_lattices() {
        const std::vector<Blurred> background = background_;
        const std::vector<Mean> foreground = foreground_;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                Blurred& own = background_[index(x, y)];
                Mean behind, before;
                for (int i = 0; i < 9; ++i) {
                    const int dx = i % 3 - 1, dy = i / 3 - 1;
                    const Blurred& other = background[index(x + dx, y + dy)];
                    if (other.kind == Blurred::blurred) behind.add(other.color, share(own.lattice, dx, dy));
                    const Mean& neighbour = foreground[index(x + dx, y + dy)];
                    const double part = share(layers_.near_lattice, dx, dy);
                    if (neighbour.any() && part > 0) before.add(neighbour.value(), neighbour.weight * part);
                }
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
