#include "findings.hpp"

#include <algorithm>
#include <cmath>

namespace postfx::host::study {
namespace {

/// Of sorted samples, between the two nearest.
double quantile_of(const std::vector<double>& sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

} // namespace

double Spread::uncertainty() const {
    if (rounds < 3) return 0.2 * std::abs(median);
    // 80 % of a normal distribution lie within 2.563 standard deviations; a median's error is 1.253 times a mean's.
    return 1.253 * (p90 - p10) / 2.563 / std::sqrt(static_cast<double>(rounds));
}

Spread spread_of(const std::vector<double>& samples) {
    if (samples.empty()) return {};
    std::vector<double> sorted = samples;
    std::sort(sorted.begin(), sorted.end());
    return {quantile_of(sorted, 0.5), quantile_of(sorted, 0.1), quantile_of(sorted, 0.9),
            static_cast<int>(sorted.size())};
}

const TruthFacts* SceneFindings::find_truth(const std::string& kind) const {
    const auto found = std::find_if(truths.begin(), truths.end(),
                                    [&](const TruthFacts& truth) { return truth.kind == kind; });
    return found == truths.end() ? nullptr : &*found;
}

double EffectFindings::own_error() const {
    double sum = 0;
    int count = 0;
    for (const SceneFindings& scene : scenes) {
        const TruthFacts* truth = scene.find_truth(judged_by);
        if (!truth || truth->statistics) continue;
        sum += truth->own_error;
        ++count;
    }
    return count == 0 ? 0 : sum / count;
}

std::optional<double> EffectFindings::inputs_error() const {
    double sum = 0;
    for (const SceneFindings& scene : scenes) {
        if (!scene.inputs_error) return std::nullopt;
        sum += *scene.inputs_error;
    }
    if (scenes.empty()) return std::nullopt;
    return sum / static_cast<double>(scenes.size());
}

const Level* EffectFindings::find(const std::string& id) const {
    const auto found =
        std::find_if(levels.begin(), levels.end(), [&](const Level& level) { return level.id == id; });
    return found == levels.end() ? nullptr : &*found;
}

} // namespace postfx::host::study
