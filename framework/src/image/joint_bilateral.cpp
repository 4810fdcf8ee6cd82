#include <image/joint_bilateral.hpp>

#include <image/rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace postfx {
namespace {

/// Values along a side of the square that counts: two to each side of a pixel.
constexpr int side = 4;
constexpr int most = side * side;
/// Of the weight by distance [values].
constexpr double spatial_deviation = 0.7;
/// Of the weight by likeness of the guide, in codes() of each channel.
constexpr double guide_deviation = 12;
/// Values that lie off a surface's plane by no more than this share of its own value are of that surface.
constexpr float same_surface = 0.06f;

/// Light as the eye grades it, so that a difference means as much in shadow as in light: 0..255, any light.
std::array<std::uint8_t, 3> codes(const float* light, int channels) {
    std::array<std::uint8_t, 3> result{};
    for (int c = 0; c < 3; ++c) {
        const float value = light[channels < 3 ? 0 : c];
        const float positive = value > 0 ? std::min(value, 1e4f) : 0.0f; // NaN is black
        result[static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(255 * std::sqrt(positive / (positive + 0.5f))));
    }
    return result;
}

/// exp(-squared distance of codes / 2 deviation^2), in steps that no weight shows.
class Likeness {
public:
    Likeness() {
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            const double squared = (static_cast<double>(i) + 0.5) * step;
            weights_[i] =
                static_cast<float>(std::exp(-squared / (2 * guide_deviation * guide_deviation)) + floor);
        }
    }
    float of(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b) const {
        int squared = 0;
        for (std::size_t c = 0; c < 3; ++c)
            squared += (a[c] - b[c]) * (a[c] - b[c]);
        return weights_[std::min<std::size_t>(static_cast<std::size_t>(squared / step), weights_.size() - 1)];
    }

private:
    static constexpr int step = 4;
    static constexpr double floor =
        1e-4; ///< where the guide is like nothing around, the nearest value counts
    std::array<float, 4096> weights_{};
};

/// A value, and how much it rises to the next in either direction.
struct Surface {
    float value = 0, across = 0, up = 0;

    /// Is a value that is so many columns and rows away on its plane, or nothing as this is?
    bool continues_to(float other, float columns, float rows) const {
        return (other > 0) == (value > 0)
               && std::abs(other - (value + across * columns + up * rows)) <= same_surface * value;
    }
};

/// The smaller of two steps of one sign, 0 between opposite ones: a neighbour beyond an edge does not tilt a surface.
float common_step(float a, float b) {
    if (a * b <= 0) return 0;
    return std::abs(a) < std::abs(b) ? a : b;
}

/// A value near a pixel: where it lies from the pixel [values], and how much it counts.
struct Neighbour {
    const Surface* surface;
    float weight, x, y;

    float value() const { return surface->value; }
};

/// Of the neighbours in order of their value, the one in the middle of all weight.
const Neighbour& weighted_median(const std::array<Neighbour, most>& neighbours, std::size_t count) {
    std::array<const Neighbour*, most> sorted{}; // by insertion: there are few
    float half = 0;
    for (std::size_t i = 0; i < count; ++i) {
        half += 0.5f * neighbours[i].weight;
        std::size_t at = i;
        for (; at > 0 && sorted[at - 1]->value() > neighbours[i].value(); --at)
            sorted[at] = sorted[at - 1];
        sorted[at] = &neighbours[i];
    }
    std::size_t at = 0;
    for (; at + 1 < count; ++at) {
        half -= sorted[at]->weight;
        if (half <= 0) break;
    }
    return *sorted[at];
}

/// Weighted least squares of value = a + b x + c y at 0, 0; the weighted mean where the places lie on a line.
struct PlaneFit {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, v = 0, xv = 0, yv = 0;

    void add(const Neighbour& n) {
        const double weight = static_cast<double>(n.weight), wx = weight * static_cast<double>(n.x),
                     wy = weight * static_cast<double>(n.y), value = static_cast<double>(n.value());
        w += weight;
        x += wx;
        y += wy;
        xx += wx * static_cast<double>(n.x);
        xy += wx * static_cast<double>(n.y);
        yy += wy * static_cast<double>(n.y);
        v += weight * value;
        xv += wx * value;
        yv += wy * value;
    }
    double at_pixel() const {
        const double mx = x / w, my = y / w, mv = v / w;
        // A little stiff against slopes that only faint values speak for.
        constexpr double stiffness = 0.02;
        const double cxx = xx / w - mx * mx + stiffness, cyy = yy / w - my * my + stiffness,
                     cxy = xy / w - mx * my;
        const double cxv = xv / w - mx * mv, cyv = yv / w - my * mv;
        const double determinant = cxx * cyy - cxy * cxy;
        const double b = (cxv * cyy - cyv * cxy) / determinant, c = (cyv * cxx - cxv * cxy) / determinant;
        return mv - b * mx - c * my;
    }
};

/// Which values stand around a line or column of pixels, and their weights by distance.
struct Around {
    int first = 0;      ///< of the values, may lie outside
    float distance = 0; ///< of the first from the pixel [values], negative or 0
    std::array<float, side> weights{};
};

std::vector<Around> places_around(int pixels, int values) {
    std::vector<Around> result(static_cast<std::size_t>(pixels));
    for (int i = 0; i < pixels; ++i) {
        const double place = (i + 0.5) * values / pixels - 0.5;
        Around& around = result[static_cast<std::size_t>(i)];
        around.first = static_cast<int>(std::floor(place)) - (side / 2 - 1);
        around.distance = static_cast<float>(around.first - place);
        for (int k = 0; k < side; ++k) {
            const double away = (around.first + k - place) / spatial_deviation;
            around.weights[static_cast<std::size_t>(k)] = static_cast<float>(std::exp(-away * away / 2));
        }
    }
    return result;
}

class Upsampling {
public:
    Upsampling(const Image& values, const Image& guide)
        : guide_(guide), width_(values.width), height_(values.height),
          across_(places_around(guide.width, values.width)), up_(places_around(guide.height, values.height)),
          surfaces_(values.pixel_count()), codes_(values.pixel_count()),
          one_surface_(static_cast<std::size_t>(values.width + 1) * (values.height + 1)) {
        for_each_row(height_, [&](int y) {
            for (int x = 0; x < width_; ++x) {
                surfaces_[index(x, y)] = surface_of(values, x, y);
                codes_[index(x, y)] = guide_at(x, y);
            }
        });
        for_each_row(height_ + 1, [&](int y) {
            for (int x = 0; x <= width_; ++x)
                one_surface_[square(x - side / 2, y - side / 2)] =
                    shows_one_surface(x - side / 2, y - side / 2);
        });
    }

    float at(int x, int y) const {
        const Around &across = across_[static_cast<std::size_t>(x)], &up = up_[static_cast<std::size_t>(y)];
        if (one_surface_[square(across.first, up.first)] != 0) return between(across, up);
        std::array<Neighbour, most> near;
        const auto own = codes(guide_.pixel(x, y), guide_.channels);
        std::size_t count = 0;
        for (int j = 0; j < side; ++j) {
            const int row = up.first + j;
            if (row < 0 || row >= height_) continue;
            for (int i = 0; i < side; ++i) {
                const int column = across.first + i;
                if (column < 0 || column >= width_) continue;
                const float by_distance =
                    across.weights[static_cast<std::size_t>(i)] * up.weights[static_cast<std::size_t>(j)];
                near[count++] = {&surfaces_[index(column, row)],
                                 by_distance * likeness_.of(own, codes_[index(column, row)]),
                                 across.distance + static_cast<float>(i),
                                 up.distance + static_cast<float>(j)};
            }
        }
        return value_of(near, count);
    }

private:
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }
    /// Of the square of values that begins there.
    std::size_t square(int first_x, int first_y) const {
        return static_cast<std::size_t>(first_y + side / 2) * (width_ + 1) + (first_x + side / 2);
    }

    static Surface surface_of(const Image& values, int x, int y) {
        const float here = values.at(x, y, 0);
        if (!(here > 0)) return {};
        Surface surface{.value = here};
        if (x > 0 && x + 1 < values.width)
            surface.across = common_step(here - values.at(x - 1, y, 0), values.at(x + 1, y, 0) - here);
        if (y > 0 && y + 1 < values.height)
            surface.up = common_step(here - values.at(x, y - 1, 0), values.at(x, y + 1, 0) - here);
        return surface;
    }

    /// The guide where a value stands.
    std::array<std::uint8_t, 3> guide_at(int x, int y) const {
        const int at_x = static_cast<int>((x + 0.5) * guide_.width / width_);
        const int at_y = static_cast<int>((y + 0.5) * guide_.height / height_);
        return codes(guide_.pixel(at_x, at_y), guide_.channels);
    }

    const Surface& clamped(int x, int y) const {
        return surfaces_[index(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1))];
    }

    /// Are all values of a square of the same surface, or is there nothing at all? Then no edge is to be kept.
    bool shows_one_surface(int first_x, int first_y) const {
        constexpr int middle = side / 2;
        const int middle_x = std::clamp(first_x + middle, 0, width_ - 1);
        const int middle_y = std::clamp(first_y + middle, 0, height_ - 1);
        const Surface& surface = clamped(middle_x, middle_y);
        for (int y = std::max(first_y, 0); y < std::min(first_y + side, height_); ++y) {
            for (int x = std::max(first_x, 0); x < std::min(first_x + side, width_); ++x) {
                if (!surface.continues_to(clamped(x, y).value, static_cast<float>(x - middle_x),
                                          static_cast<float>(y - middle_y)))
                    return false;
            }
        }
        return true;
    }

    /// Between the four values around a pixel, which is exact on planes.
    float between(const Around& across, const Around& up) const {
        constexpr int before = side / 2 - 1;
        const float right = -across.distance - before, above = -up.distance - before;
        const int x = across.first + before, y = up.first + before;
        return std::lerp(std::lerp(clamped(x, y).value, clamped(x + 1, y).value, right),
                         std::lerp(clamped(x, y + 1).value, clamped(x + 1, y + 1).value, right), above);
    }

    static float value_of(const std::array<Neighbour, most>& near, std::size_t count) {
        const Neighbour& seen = weighted_median(near, count);
        if (!(seen.value() > 0)) return 0;
        PlaneFit fit;
        float lowest = seen.value(), highest = seen.value();
        for (std::size_t i = 0; i < count; ++i) {
            const Neighbour& n = near[i];
            if (!seen.surface->continues_to(n.value(), n.x - seen.x, n.y - seen.y)) continue;
            fit.add(n);
            lowest = std::min(lowest, n.value());
            highest = std::max(highest, n.value());
        }
        return std::clamp(static_cast<float>(fit.at_pixel()), lowest, highest);
    }

    const Image& guide_;
    int width_, height_;              ///< of the values
    std::vector<Around> across_, up_; ///< for each column and line of the guide
    Likeness likeness_;
    std::vector<Surface> surfaces_;
    std::vector<std::array<std::uint8_t, 3>> codes_; ///< of the guide, at each value
    std::vector<std::uint8_t> one_surface_;          ///< of each square()
};

} // namespace

Image joint_bilateral(const Image& values, const Image& guide) {
    const Upsampling upsampling(values, guide);
    Image result(guide.width, guide.height, 1);
    for_each_row(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x)
            result.at(x, y, 0) = upsampling.at(x, y);
    });
    return result;
}

Image nearest_values(const Image& values, int width, int height) {
    Image result(width, height, 1);
    for (int y = 0; y < height; ++y) {
        const int from_y = static_cast<int>((y + 0.5) * values.height / height);
        for (int x = 0; x < width; ++x)
            result.at(x, y, 0) = values.at(static_cast<int>((x + 0.5) * values.width / width), from_y, 0);
    }
    return result;
}

} // namespace postfx
