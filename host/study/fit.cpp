#include "fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace postfx::host::study {
namespace {

/// Sums of a weighted line y = fixed + slope x.
struct Sums {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0;
    void add(double px, double py, double weight) {
        w += weight;
        x += weight * px;
        y += weight * py;
        xx += weight * px * px;
        xy += weight * px * py;
    }
    double spread() const { return w * xx - x * x; }
    double slope() const { return (w * xy - x * y) / spread(); }
};

/// One point for all of the same x.
Points means_by_place(const Points& points) {
    std::map<double, std::pair<double, int>> sums;
    for (const auto& [x, y] : points) {
        sums[x].first += y;
        ++sums[x].second;
    }
    Points means;
    for (const auto& [x, sum] : sums)
        means.emplace_back(x, sum.first / sum.second);
    return means;
}

} // namespace

std::optional<double> exponent_of(const Points& points) {
    Sums sums;
    for (const auto& [x, y] : points) {
        if (x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y)) sums.add(std::log(x), std::log(y), 1);
    }
    // Rounding leaves a little of the spread of equal points.
    if (sums.spread() <= 1e-9 * std::max(1.0, sums.w * sums.xx)) return std::nullopt;
    return sums.slope();
}

TimeCurve fit_time(const Points& measured) {
    const Points points = means_by_place(measured);
    Sums sums;
    double largest = 0;
    for (const auto& [x, y] : points)
        largest = std::max(largest, y);
    if (largest <= 0) return {};
    for (const auto& [x, y] : points) {
        const double scale = std::max(y, 0.01 * largest); // what is lost in noise has no say of its own
        sums.add(x, y, 1 / (scale * scale));
    }
    const double mean = sums.y / sums.w;
    if (sums.spread() <= 1e-9 * sums.w * sums.xx) return {std::max(0.0, mean), 0};
    const double slope = sums.slope(), fixed = (sums.y - slope * sums.x) / sums.w;
    if (slope < 0) return {std::max(0.0, mean), 0};
    if (fixed < 0) return {0, sums.xy / sums.xx};
    return {fixed, slope};
}

} // namespace postfx::host::study
