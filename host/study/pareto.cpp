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

bool dominates(const Rung& better, const Rung& rung, double own_error) {
    const int time = compare_times(better.ms, rung.ms);
    const int error = compare_errors(*better.error, *rung.error, own_error);
    return time <= 0 && error <= 0 && time + error < 0;
}

std::optional<double> error_of(const EffectFindings& effect, const Rung& rung) {
    if (effect.judged_by.empty()) {
        for (std::size_t i = 0; i < effect.metrics.size(); ++i) {
            if (effect.metrics[i].stands_for_error && !std::isnan(rung.metrics[i])) return rung.metrics[i];
        }
        return std::nullopt;
    }
    double sum = 0;
    int count = 0;
    for (const RungOnScene& scene : rung.scenes) {
        const auto found = scene.errors.find(effect.judged_by);
        if (found == scene.errors.end()) continue;
        sum += found->second.relative_rmse;
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
}

/// Time at the first size, mean over scenes; the curve through all sizes.
void conclude_times(Rung& rung) {
    Points points;
    rung.ms = {};
    int scenes = 0;
    for (const RungOnScene& scene : rung.scenes) {
        for (const Cost& cost : scene.costs)
            points.emplace_back(cost.megapixels(), cost.ms.median);
        if (scene.costs.empty()) continue;
        const Spread& ms = scene.costs.front().ms;
        rung.ms.median += ms.median;
        rung.ms.p10 += ms.p10;
        rung.ms.p90 += ms.p90;
        rung.ms.rounds = scenes == 0 ? ms.rounds : std::min(rung.ms.rounds, ms.rounds);
        ++scenes;
    }
    for (double* value : {&rung.ms.median, &rung.ms.p10, &rung.ms.p90})
        *value /= std::max(scenes, 1);
    rung.time = fit_time(points);
}

void find_dominated(EffectFindings& effect) {
    const double own_error = effect.own_error();
    for (Rung& rung : effect.rungs) {
        rung.dominated_by.clear();
        const Rung* best = nullptr;
        for (const Rung& other : effect.rungs) {
            if (&other == &rung || !rung.error || !other.error || !dominates(other, rung, own_error))
                continue;
            if (!best || *other.error < *best->error) best = &other;
        }
        if (best) rung.dominated_by = best->level;
    }
}

std::optional<double> mean_taps(const Rung& rung) {
    double sum = 0;
    for (const RungOnScene& scene : rung.scenes) {
        if (!scene.taps) return std::nullopt;
        sum += *scene.taps;
    }
    if (rung.scenes.empty()) return std::nullopt;
    return sum / static_cast<double>(rung.scenes.size());
}

void find_hull(EffectFindings& effect) {
    std::vector<std::size_t> indices;
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < effect.rungs.size(); ++i) {
        Rung& rung = effect.rungs[i];
        rung.on_hull = false;
        if (!rung.error || !(rung.ms.median > 0) || !(*rung.error > 0) || std::isinf(*rung.error)) continue;
        indices.push_back(i);
        points.emplace_back(std::log(rung.ms.median), std::log(*rung.error));
    }
    for (const std::size_t i : lower_hull(points))
        effect.rungs[indices[i]].on_hull = true;
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
    for (Rung& rung : effect.rungs) {
        conclude_times(rung);
        rung.error = error_of(effect, rung);
        rung.taps = mean_taps(rung);
    }
    find_dominated(effect);
    find_hull(effect);
}

std::vector<std::size_t> curve_of(const EffectFindings& effect) {
    std::vector<std::size_t> curve;
    for (std::size_t i = 0; i < effect.rungs.size(); ++i) {
        const Rung& rung = effect.rungs[i];
        if (rung.level == classic_level) continue; // there to be compared with, not to be used
        if (rung.error && std::isfinite(*rung.error) && rung.dominated_by.empty()) curve.push_back(i);
    }
    const auto& rungs = effect.rungs;
    std::sort(curve.begin(), curve.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(rungs[a].ms.median, *rungs[a].error)
               < std::pair(rungs[b].ms.median, *rungs[b].error);
    });
    // Of rungs that noise does not tell apart, the numbers decide.
    double least = std::numeric_limits<double>::infinity();
    std::erase_if(curve, [&](std::size_t i) {
        if (*rungs[i].error >= least) return true;
        least = *rungs[i].error;
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
            const Rung& rung = effect.rungs[i];
            curves.effects[effect.id].push_back({rung.level, rung.time, *rung.error, rung.step_to_next});
        }
    }
    return curves;
}

} // namespace postfx::host::study
