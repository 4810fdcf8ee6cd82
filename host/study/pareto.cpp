#include "pareto.hpp"

#include "fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace postfx::host::study {
namespace {

/// -1, 0 or 1: a clearly less than b, neither, clearly more.
int compare(double a, double b, double noise) {
    if (std::isinf(a) || std::isinf(b)) return a < b ? -1 : a > b ? 1 : 0;
    return std::abs(a - b) <= noise ? 0 : a < b ? -1 : 1;
}

int compare_times(const Spread& a, const Spread& b) {
    const double noise = 2 * std::hypot(a.uncertainty(), b.uncertainty());
    return compare(a.median, b.median, std::max(noise, 0.02 * std::max(a.median, b.median)));
}

/// Below its own error a truth tells nothing; above, its noise is the same for all that are compared with it.
int compare_errors(double a, double b, double own_error) {
    const double x = std::max(a, own_error), y = std::max(b, own_error);
    return compare(x, y, 0.02 * std::max(x, y));
}

bool dominates(const Level& better, const Level& level, double own_error) {
    const int time = compare_times(better.ms, level.ms);
    const int error = compare_errors(*better.error, *level.error, own_error);
    return time <= 0 && error <= 0 && time + error < 0;
}

std::optional<double> error_of(const EffectFindings& effect, const Level& level) {
    if (effect.judged_by.empty()) {
        for (std::size_t i = 0; i < effect.metrics.size(); ++i) {
            if (effect.metrics[i].stands_for_error && !std::isnan(level.metrics[i])) return level.metrics[i];
        }
        return std::nullopt;
    }
    double sum = 0;
    int count = 0;
    for (const LevelOnScene& scene : level.scenes) {
        const auto found = scene.errors.find(effect.judged_by);
        if (found == scene.errors.end()) continue;
        sum += found->second.relative_rmse;
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
}

/// Time at the first size, mean over scenes; the curve through all sizes.
void conclude_times(Level& level) {
    Points points;
    level.ms = {};
    int scenes = 0;
    for (const LevelOnScene& scene : level.scenes) {
        for (const Cost& cost : scene.costs)
            points.emplace_back(cost.megapixels(), cost.ms.median);
        if (scene.costs.empty()) continue;
        const Spread& ms = scene.costs.front().ms;
        level.ms.median += ms.median;
        level.ms.p10 += ms.p10;
        level.ms.p90 += ms.p90;
        level.ms.rounds = scenes == 0 ? ms.rounds : std::min(level.ms.rounds, ms.rounds);
        ++scenes;
    }
    for (double* value : {&level.ms.median, &level.ms.p10, &level.ms.p90})
        *value /= std::max(scenes, 1);
    level.time = fit_time(points);
}

void find_dominated(EffectFindings& effect) {
    const double own_error = effect.own_error();
    for (Level& level : effect.levels) {
        level.dominated_by.clear();
        const Level* best = nullptr;
        for (const Level& other : effect.levels) {
            if (&other == &level || !level.error || !other.error || !dominates(other, level, own_error))
                continue;
            if (!best || *other.error < *best->error) best = &other;
        }
        if (best) level.dominated_by = best->id;
    }
}

std::optional<double> mean_taps(const Level& level) {
    double sum = 0;
    for (const LevelOnScene& scene : level.scenes) {
        if (!scene.taps) return std::nullopt;
        sum += *scene.taps;
    }
    if (level.scenes.empty()) return std::nullopt;
    return sum / static_cast<double>(level.scenes.size());
}

void find_hull(EffectFindings& effect) {
    std::vector<std::size_t> indices;
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < effect.levels.size(); ++i) {
        Level& level = effect.levels[i];
        level.on_hull = false;
        if (!level.error || !(level.ms.median > 0) || !(*level.error > 0) || std::isinf(*level.error))
            continue;
        indices.push_back(i);
        points.emplace_back(std::log(level.ms.median), std::log(*level.error));
    }
    for (const std::size_t i : lower_hull(points))
        effect.levels[indices[i]].on_hull = true;
}

} // namespace

std::vector<std::size_t> lower_hull(const std::vector<std::pair<double, double>>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
    std::vector<std::size_t> hull;
    const auto turns_up = [&](std::size_t a, std::size_t b, std::size_t c) {
        return (points[b].first - points[a].first) * (points[c].second - points[a].second)
                   - (points[b].second - points[a].second) * (points[c].first - points[a].first)
               > 0;
    };
    for (const std::size_t i : order) {
        // Only what is lower than all before can be on the way down.
        if (!hull.empty() && points[i].second >= points[hull.back()].second) continue;
        while (hull.size() >= 2 && !turns_up(hull[hull.size() - 2], hull.back(), i))
            hull.pop_back();
        hull.push_back(i);
    }
    return hull;
}

void conclude(EffectFindings& effect) {
    for (Level& level : effect.levels) {
        conclude_times(level);
        level.error = error_of(effect, level);
        level.taps = mean_taps(level);
    }
    find_dominated(effect);
    find_hull(effect);
}

std::vector<std::size_t> curve_of(const EffectFindings& effect) {
    std::vector<std::size_t> curve;
    for (std::size_t i = 0; i < effect.levels.size(); ++i) {
        const Level& level = effect.levels[i];
        if (level.id == classic_level) continue; // there to be compared with, not to be used
        if (level.error && std::isfinite(*level.error) && level.dominated_by.empty()) curve.push_back(i);
    }
    const auto& levels = effect.levels;
    std::sort(curve.begin(), curve.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(levels[a].ms.median, *levels[a].error)
               < std::pair(levels[b].ms.median, *levels[b].error);
    });
    // Of levels that noise does not tell apart, the numbers decide.
    double least = std::numeric_limits<double>::infinity();
    std::erase_if(curve, [&](std::size_t i) {
        if (*levels[i].error >= least) return true;
        least = *levels[i].error;
        return false;
    });
    return curve;
}

Curves curves_of(const Findings& findings) {
    const Conditions& conditions = findings.conditions;
    Curves curves{.device = conditions.device,
                  .driver = conditions.driver,
                  .clock = conditions.clock,
                  .made_by = conditions.command + ", " + conditions.program,
                  .base = findings.base,
                  .effects = {}};
    for (const EffectFindings& effect : findings.effects) {
        for (const std::size_t i : curve_of(effect)) {
            const Level& level = effect.levels[i];
            curves.effects[effect.id].push_back({level.id, level.time, *level.error, level.step_to_next});
        }
    }
    return curves;
}

} // namespace postfx::host::study
