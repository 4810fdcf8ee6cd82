#include "budget/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace postfx {

/// Points come in order of time; what is dominated is left out. Of equal ones the first stays.
void ParetoFront::Merged::take(const FrontPoint& point, Origin origin) {
    if (!points.empty() && !(point.squared_error < points.back().squared_error)) return;
    if (!points.empty() && points.back().ms == point.ms) {
        points.back() = point;
        origins.back() = origin;
        return;
    }
    points.push_back(point);
    origins.push_back(origin);
}

/// `a` and this front with the option added to every point, which keeps its order.
ParetoFront::Merged ParetoFront::merge(const Merged& a, const FrontPoint& option,
                                       std::uint32_t number) const {
    Merged merged;
    merged.points.reserve(a.points.size() + points_.size());
    merged.origins.reserve(a.points.size() + points_.size());
    std::size_t i = 0;
    for (std::size_t j = 0; j < points_.size(); ++j) {
        const FrontPoint next = {points_[j].ms + option.ms, points_[j].squared_error + option.squared_error};
        for (; i < a.points.size() && a.points[i].ms <= next.ms; ++i)
            merged.take(a.points[i], a.origins[i]);
        merged.take(next, {static_cast<std::uint32_t>(j), number});
    }
    for (; i < a.points.size(); ++i)
        merged.take(a.points[i], a.origins[i]);
    return merged;
}

void ParetoFront::add(const std::vector<FrontPoint>& options) {
    Merged merged;
    for (std::size_t i = 0; i < options.size(); ++i)
        merged = merge(merged, options[i], static_cast<std::uint32_t>(i));
    if (merged.points.size() > most_) thin(merged);
    points_ = std::move(merged.points);
    origins_.push_back(std::move(merged.origins));
}

/// Squared errors are sorted into classes of one ratio; the cheapest of each comes first. The most exact point of all
/// stays, so that what can be met at all is met.
void ParetoFront::thin(Merged& front) {
    const double largest = front.points.front().squared_error;
    const double least = std::max(front.points.back().squared_error, negligible_share * largest);
    const double classes = static_cast<double>(most_ - 2);
    const double step = std::log(largest / least) / classes;
    Merged kept;
    double last_class = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < front.points.size(); ++i) {
        const double squared = front.points[i].squared_error;
        const double its_class = squared < least ? -1 : std::floor(std::log(squared / least) / step);
        const bool most_exact = i + 1 == front.points.size();
        if (its_class == last_class && !most_exact) continue;
        kept.take(front.points[i], front.origins[i]);
        last_class = its_class;
    }
    front = std::move(kept);
    loss_ = (1 + loss_) * std::exp(step) - 1;
}

std::vector<std::size_t> ParetoFront::picks(std::size_t point) const {
    std::vector<std::size_t> picks(origins_.size());
    for (std::size_t group = origins_.size(); group-- > 0;) {
        const Origin& origin = origins_[group].at(point);
        picks[group] = origin.option;
        point = origin.before;
    }
    return picks;
}

} // namespace postfx
