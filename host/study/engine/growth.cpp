#include "growth.hpp"

#include "study/fit.hpp"
#include "terminal/interruption.hpp"

#include <image/metrics.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace postfx::host::study {
namespace {

constexpr double smallest_radius = 2, largest_radius = 256; // pixels

/// About 0.1, 0.45, 2 and 8 megapixels, 16:9.
constexpr Size growing_sizes[] = {{416, 234}, {896, 504}, {1920, 1080}, {3840, 2160}};

/// Growth needs no more than the middle: a few rounds do.
TimeOptions few_rounds(TimeOptions times) {
    times.rounds = std::min(times.rounds, 5);
    times.seconds /= 4;
    return times;
}

/// Errors over the radius are told in logarithms: an eighth of the truth's samples is enough.
constexpr double share_of_samples = 0.125;

/// Those that may be drawn: by what a draw of them is expected to take.
std::vector<std::size_t> affordable(const EffectFindings& findings, double limit_ms, double megapixels) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < findings.levels.size(); ++i) {
        if (findings.levels[i].time.at(megapixels) <= limit_ms) indices.push_back(i);
    }
    return indices;
}

void fit(Growth& growth) {
    for (GrowthCurve& curve : growth.curves) {
        Points times, errors;
        for (const GrowthCurve::Point& point : curve.points) {
            times.emplace_back(point.at, point.ms);
            if (point.error) errors.emplace_back(point.at, *point.error);
        }
        curve.time_exponent = exponent_of(times);
        curve.error_exponent = exponent_of(errors);
    }
    std::erase_if(growth.curves, [](const GrowthCurve& curve) { return curve.points.empty(); });
}

std::vector<GrowthCurve> curves_for(const EffectFindings& findings) {
    std::vector<GrowthCurve> curves;
    for (const Level& level : findings.levels)
        curves.push_back({.level = level.id, .points = {}, .time_exponent = {}, .error_exponent = {}});
    return curves;
}

void leave_out_slow(Growth& growth, const EffectFindings& findings, const std::vector<std::size_t>& drawn) {
    for (std::size_t i = 0; i < findings.levels.size(); ++i) {
        if (std::find(drawn.begin(), drawn.end(), i) == drawn.end())
            growth.left_out.push_back(findings.levels[i].name());
    }
}

std::vector<ChainEntry> chosen(const std::vector<ChainEntry>& entries,
                               const std::vector<std::size_t>& indices) {
    std::vector<ChainEntry> result;
    for (const std::size_t i : indices)
        result.push_back(entries[i]);
    return result;
}

Growth over_pixels(const GrowthInputs& inputs, const EffectFindings& findings) {
    Growth growth{.over = "pixels",
                  .scene = inputs.scene.scene.name,
                  .truth = "",
                  .conditions = "pictures of 0.1 to 8 megapixels, 16:9",
                  .curves = curves_for(findings),
                  .left_out = {}};
    for (const Size& size : growing_sizes) {
        const double megapixels = 1e-6 * size.width * size.height;
        // The whole of a size may take as much as a draw of a level at the size of times, many times over.
        const auto drawn = affordable(findings, 4 * inputs.limit_ms, megapixels);
        if (&size == &growing_sizes[0]) leave_out_slow(growth, findings, drawn);
        if (drawn.empty()) continue;
        const View view(inputs.scene, *inputs.entries.front().effect, size, 1);
        const TimedEntries timed =
            measure_entries(view, chosen(inputs.entries, drawn), few_rounds(inputs.times),
                            fmt::format("{}, growth at {}x{}", findings.id, size.width, size.height));
        for (std::size_t k = 0; k < drawn.size(); ++k)
            growth.curves[drawn[k]].points.push_back({megapixels, timed.costs[k].ms.median, {}});
    }
    fit(growth);
    return growth;
}

/// Errors of the chosen levels at one radius, from the truth of that radius.
std::vector<std::optional<double>> errors_at(const GrowthInputs& inputs, const View& view,
                                             const std::string& kind,
                                             const std::vector<ChainEntry>& entries) {
    std::vector<std::optional<double>> errors(entries.size());
    auto registered = truths_of(entries.front().effect->id);
    std::erase_if(registered, [&](const RegisteredTruth* truth) { return truth->kind != kind; });
    TruthOptions options = inputs.truths;
    options.share = share_of_samples;
    const Truths truths = sum_up_truths(registered, inputs.scene.scene, view, entries.front(), options);
    const SummedTruth* truth = truths.find(kind);
    if (!truth || truth->facts.statistics) return errors;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        StopOnInterrupt::check();
        errors[i] = relative_error(picture_of(entries[i], view).light, truth->picture).relative_rmse;
    }
    return errors;
}

/// The truth that errors over the radius are from: what the effect could do with what it is given, if there is one.
std::string growth_kind(const std::string& effect, const std::string& judged_by) {
    for (const RegisteredTruth* truth : truths_of(effect)) {
        if (truth->kind == "layer" && truth->compared == RegisteredTruth::Compared::pixels) return "layer";
    }
    return judged_by;
}

Growth over_radius(const GrowthInputs& inputs, const EffectFindings& findings) {
    const RadiusSpec& radius = *inputs.radius;
    const EffectInfo& effect = *inputs.entries.front().effect;
    const std::string kind = growth_kind(effect.id, inputs.judged_by);
    Growth growth{.over = "radius",
                  .scene = inputs.scene.scene.name,
                  .truth = kind,
                  .conditions = fmt::format("radius set by its parameter {}; times at {}x{}, errors at {}x{}",
                                            radius.parameter, inputs.time_size.width, inputs.time_size.height,
                                            inputs.picture.width, inputs.picture.height),
                  .curves = curves_for(findings),
                  .left_out = {}};
    const double megapixels = 1e-6 * inputs.time_size.width * inputs.time_size.height;
    const auto drawn = affordable(findings, inputs.limit_ms, megapixels);
    leave_out_slow(growth, findings, drawn);
    if (drawn.empty()) return growth;
    const View view(inputs.scene, effect, inputs.time_size, 1),
        small(inputs.scene, effect, inputs.picture, 4);
    for (double pixels = smallest_radius; pixels <= largest_radius; pixels *= 2) {
        std::vector<ChainEntry> entries = chosen(inputs.growing_entries, drawn);
        const auto set_radius = [&](const View& of) {
            const auto value = value_for_radius(radius, effect, pixels, of.size().height);
            for (ChainEntry& entry : entries) {
                if (value) entry.set(radius.parameter, *value);
            }
            return value.has_value();
        };
        std::vector<std::optional<double>> errors(drawn.size());
        if (!kind.empty() && set_radius(small)) errors = errors_at(inputs, small, kind, entries);
        if (!set_radius(view)) continue;
        const TimedEntries timed = measure_entries(view, entries, few_rounds(inputs.times),
                                                   fmt::format("{}, radius {:.0f}", effect.id, pixels));
        for (std::size_t k = 0; k < drawn.size(); ++k)
            growth.curves[drawn[k]].points.push_back({pixels, timed.costs[k].ms.median, errors[k]});
    }
    fit(growth);
    return growth;
}

} // namespace

std::vector<Growth> find_growth(const GrowthInputs& inputs, const EffectFindings& findings) {
    std::vector<Growth> growth;
    if (inputs.radius) growth.push_back(over_radius(inputs, findings));
    growth.push_back(over_pixels(inputs, findings));
    return growth;
}

} // namespace postfx::host::study
