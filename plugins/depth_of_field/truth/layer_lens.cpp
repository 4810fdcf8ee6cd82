#include "layer_lens.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace postfx::host {
namespace {

/// Areas up to this are what float64 leaves of differences.
constexpr double rounding = 1e-9;

/// The smaller of two slopes of one sign, 0 between opposite ones: a neighbour beyond an edge does not tilt a
/// surface.
double common_slope(double a, double b) {
    if (a * b <= 0) return 0;
    return std::abs(a) < std::abs(b) ? a : b;
}

/// Where `pixel` of `count` continues on both sides; at the border on the side that there is.
template<class Value>
double slope_along(int pixel, int count, const Value& value) {
    if (count < 2) return 0;
    const double here = value(pixel);
    if (pixel == 0) return value(1) - here;
    if (pixel == count - 1) return here - value(pixel - 1);
    return common_slope(here - value(pixel - 1), value(pixel + 1) - here);
}

/// From low to high, pixels.
struct Span {
    double low, high;

    Span(double middle, double length) : low(middle - length / 2), high(middle + length / 2) {}
    int first() const { return static_cast<int>(std::floor(low)); }
    int last() const { return static_cast<int>(std::ceil(high)) - 1; }
    /// Of pixel `index`, which reaches from index to index + 1.
    double part(int index) const {
        return std::max(0.0, std::min(high, index + 1.0) - std::max(low, double(index)));
    }
};

} // namespace

LayerLens::LayerLens(Image64 color, std::vector<double> inverse_distance, const ThinLens& lens)
    : color_(std::move(color)), inverse_distance_(std::move(inverse_distance)),
      slope_(inverse_distance_.size()), nearest_first_(inverse_distance_.size()),
      view_(inverse_distance_.size()), focus_(lens.focus),
      pixels_(lens.aperture / 2 * color_.height / (2 * lens.half_extent.y)) {
    const int width = color_.width, height = color_.height;
    const auto at = [&](int x, int y) { return inverse_distance_[static_cast<std::size_t>(y) * width + x]; };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            slope_[static_cast<std::size_t>(y) * width + x] = {
                slope_along(x, width, [&](int other) { return at(other, y); }),
                slope_along(y, height, [&](int other) { return at(x, other); })};
        }
    }
    std::iota(nearest_first_.begin(), nearest_first_.end(), std::size_t(0));
    std::stable_sort(nearest_first_.begin(), nearest_first_.end(), [&](std::size_t a, std::size_t b) {
        return inverse_distance_[a] > inverse_distance_[b];
    });
}

void LayerLens::add(glm::dvec2 point, Image64& sum) {
    const glm::dvec2 shift = pixels_ * point;
    if (focus_[0] == focus_[1] && focus_[1] == focus_[2]) return add_channels(shift, focus_[0], 0, 3, sum);
    for (int channel = 0; channel < 3; ++channel)
        add_channels(shift, focus_[static_cast<std::size_t>(channel)], channel, channel + 1, sum);
}

void LayerLens::add_channels(glm::dvec2 shift, double focus, int first, int last, Image64& sum) {
    look(shift, focus);
    for (std::size_t pixel = 0; pixel < view_.size(); ++pixel) {
        const Seen seen = filled(pixel, shift);
        double* to = &sum.values[channels * pixel];
        for (int c = first; c < last; ++c) {
            to[c] += seen.light[c];
            to[3 + c] += seen.area;
        }
    }
}

void LayerLens::look(glm::dvec2 shift, double focus) {
    const int width = color_.width, height = color_.height;
    std::fill(view_.begin(), view_.end(), Seen());
    for (const std::size_t pixel : nearest_first_) {
        const glm::dvec2 move = shift * (focus - inverse_distance_[pixel]);
        const glm::dvec2 size = glm::abs(1.0 - shift * slope_[pixel]);
        const Span across(static_cast<double>(pixel % width) + 0.5 + move.x, size.x);
        const Span up(static_cast<double>(pixel / width) + 0.5 + move.y, size.y);
        const glm::dvec3 light = glm::make_vec3(&color_.values[3 * pixel]);
        for (int y = std::max(up.first(), 0); y <= std::min(up.last(), height - 1); ++y) {
            for (int x = std::max(across.first(), 0); x <= std::min(across.last(), width - 1); ++x) {
                Seen& seen = view_[static_cast<std::size_t>(y) * width + x];
                const double area = std::min(across.part(x) * up.part(y), 1 - seen.area);
                if (area <= rounding) continue;
                seen.light += area * light;
                seen.farthest = pixel;
                seen.area += area;
            }
        }
    }
}

LayerLens::Seen LayerLens::filled(std::size_t pixel, glm::dvec2 shift) const {
    const Seen& seen = view_[pixel];
    const double largest = std::max(std::abs(shift.x), std::abs(shift.y));
    if (seen.area >= 1 - rounding || largest == 0) return seen;
    const Seen* before = next_known(pixel, -shift / largest);
    const Seen* after = next_known(pixel, shift / largest);
    if (!before || !after) return seen;
    const bool before_is_farther = inverse_distance_[before->farthest] < inverse_distance_[after->farthest];
    // The patch's own light: in the pixel it may be mixed with that of a lamp before it.
    const std::size_t farther = before_is_farther ? before->farthest : after->farthest;
    return {seen.light + (1 - seen.area) * glm::make_vec3(&color_.values[3 * farther]), 1, farther};
}

const LayerLens::Seen* LayerLens::next_known(std::size_t pixel, glm::dvec2 step) const {
    const int width = color_.width, height = color_.height;
    glm::dvec2 place(static_cast<double>(pixel % width) + 0.5, static_cast<double>(pixel / width) + 0.5);
    for (;;) {
        place += step;
        const int x = static_cast<int>(std::floor(place.x)), y = static_cast<int>(std::floor(place.y));
        if (x < 0 || y < 0 || x >= width || y >= height) return nullptr;
        const Seen& seen = view_[static_cast<std::size_t>(y) * width + x];
        if (seen.area >= 1 - rounding) return &seen;
    }
}

Image64 LayerLens::picture(const Image64& sum) const {
    Image64 result = color_;
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        const double* from = &sum.values[i / 3 * channels + i % 3];
        if (from[3] > 0) result.values[i] = from[0] / from[3];
    }
    return result;
}

} // namespace postfx::host
