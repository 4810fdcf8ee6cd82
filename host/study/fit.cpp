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

/// Of logarithms of positive numbers.
Sums log_sums(const Points& points) {
    Sums sums;
    for (const auto& [x, y] : points) {
        if (x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y)) sums.add(std::log(x), std::log(y), 1);
    }
    return sums;
}

/// Rounding leaves a little of the spread of equal points.
bool differ_in_x(const Sums& sums) {
    return sums.spread() > 1e-9 * std::max(1.0, sums.w * sums.xx);
}

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
    const Sums sums = log_sums(points);
    return differ_in_x(sums) ? std::optional(sums.slope()) : std::nullopt;
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
    if (sums.spread() <= 1e-9 * sums.w * sums.xx) return {std::max(0.0, mean), 0, 1};
    const double slope = sums.slope(), fixed = (sums.y - slope * sums.x) / sums.w;
    if (slope < 0) return {std::max(0.0, mean), 0, 1};
    if (fixed >= 0) return {fixed, slope, 1};
    // A straight line would have to begin below 0: every pixel takes more, the more there are.
    const Sums logs = log_sums(points);
    if (!differ_in_x(logs) || logs.slope() < 1) return {0, sums.xy / sums.xx, 1};
    return {0, std::exp((logs.y - logs.slope() * logs.x) / logs.w), logs.slope()};
}

} // namespace postfx::host::study
