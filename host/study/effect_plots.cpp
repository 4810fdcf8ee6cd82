#include "effect_plots.hpp"

#include "pareto.hpp"
#include "plot.hpp"
#include "sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace postfx::host::study {
namespace {

constexpr double percent = 0.01;

/// Of a level, mean over scenes; none where any scene lacks it.
std::optional<double> mean_over_scenes(const Level& level, const std::string& kind,
                                       double PictureError::*value) {
    double sum = 0;
    for (const LevelOnScene& scene : level.scenes) {
        const auto found = scene.errors.find(kind);
        if (found == scene.errors.end()) return std::nullopt;
        sum += found->second.*value;
    }
    if (level.scenes.empty()) return std::nullopt;
    return sum / static_cast<double>(level.scenes.size());
}

/// Times that are no more than noise can't be drawn on a logarithmic axis: this is the least that is.
double least_time(const EffectFindings& effect) {
    constexpr double least_copies = 0.03; // no measurement here tells less
    double least = 0;
    for (const Level& level : effect.levels) {
        for (const LevelOnScene& scene : level.scenes) {
            if (scene.costs.empty() || !(scene.costs[0].copies.median > 0)) continue;
            least = std::max(least, least_copies * scene.costs[0].ms.median / scene.costs[0].copies.median);
        }
    }
    return least > 0 ? least : 1e-3;
}

using ErrorOf = std::function<std::optional<double>(const Level&)>;

ScatterPlot scatter(const EffectFindings& effect, const ErrorOf& error_of, const std::string& y_label) {
    ScatterPlot plot;
    plot.x_label = "time that it adds, ms";
    plot.y_label = y_label;
    plot.y_unit = percent;
    plot.x_floor = least_time(effect);
    double least = 0;
    for (const Level& level : effect.levels) {
        const auto error = error_of(level);
        if (!error) continue;
        plot.marks.push_back({.label = level.name(),
                              .x = level.ms.median,
                              .y = *error,
                              .x_low = level.ms.p10,
                              .x_high = level.ms.p90,
                              .classic = level.id == classic_level});
        if (*error > 0 && (least == 0 || *error < least)) least = *error;
    }
    plot.y_floor = least > 0 ? least / 3 : 1e-6;
    return plot;
}

void show_verdicts(ScatterPlot& plot, const EffectFindings& effect) {
    for (Mark& mark : plot.marks) {
        for (const Level& level : effect.levels) {
            if (level.name() != mark.label) continue;
            mark.hollow = !level.dominated_by.empty();
            mark.on_hull = level.on_hull;
        }
    }
}

/// A floor far below all marks would only squeeze them.
void add_floor(ScatterPlot& plot, double y, const std::string& label) {
    constexpr double far = 30;
    if (y * far > plot.y_floor) plot.floors.push_back({y, label});
}

EffectPlot judged_plot(const EffectFindings& effect) {
    ScatterPlot plot = scatter(
        effect, [](const Level& level) { return level.error; },
        effect.judged_by == "layer" ? "error from the best of its inputs, %" : "error from the truth, %");
    plot.title = fmt::format("{}: error against time", effect.id);
    show_verdicts(plot, effect);
    add_floor(plot, effect.own_error(), "what the truth knows of itself");
    const auto inputs = effect.inputs_error();
    if (effect.judged_by == "scene" && inputs) add_floor(plot, *inputs, "the best that its inputs allow");
    return {"error", fmt::format("Error against time: {}.", effect.error_is), scatter_svg(plot)};
}

EffectPlot other_plot(const EffectFindings& effect, const std::string& kind) {
    ScatterPlot plot = scatter(
        effect,
        [&](const Level& level) { return mean_over_scenes(level, kind, &PictureError::relative_rmse); },
        kind == "layer" ? "error from the best of its inputs, %" : "error from the scene's truth, %");
    plot.title = fmt::format("{}: error against time, truth of kind {}", effect.id, kind);
    return {kind,
            kind == "layer" ? "The same, from the best that can be made of what the effect is given."
                            : "The same, from the truth of the scene itself.",
            scatter_svg(plot)};
}

EffectPlot flip_plot(const EffectFindings& effect) {
    ScatterPlot plot = scatter(
        effect,
        [&](const Level& level) { return mean_over_scenes(level, effect.judged_by, &PictureError::flip); },
        "difference that is seen (FLIP), %");
    plot.title = fmt::format("{}: FLIP against time", effect.id);
    return {"flip", "The same, as a viewer sees it who flips between picture and truth.", scatter_svg(plot)};
}

std::string line_name(const GrowthCurve& curve, const std::optional<double>& exponent) {
    const std::string name = curve.level.empty() ? "its only level" : curve.level;
    return exponent ? fmt::format("{} ^{:.2f}", name, *exponent) : name;
}

EffectPlot growth_plot(const EffectFindings& effect, const Growth& growth, bool errors) {
    LinePlot plot;
    const bool radius = growth.over == "radius";
    plot.x_label = radius ? "radius, pixels" : "size of the picture, megapixels";
    plot.y_label = errors ? "error, %" : "time that it adds, ms";
    plot.y_unit = errors ? percent : 1;
    plot.title = fmt::format("{}: {} against {}", effect.id, errors ? "error" : "time", growth.over);
    const double last = std::max<double>(1, static_cast<double>(growth.curves.size()) - 1);
    for (std::size_t i = 0; i < growth.curves.size(); ++i) {
        const GrowthCurve& curve = growth.curves[i];
        Line line{.label = line_name(curve, errors ? curve.error_exponent : curve.time_exponent),
                  .points = {},
                  .shade = static_cast<double>(i) / last,
                  .classic = curve.level == classic_level};
        for (const GrowthCurve::Point& point : curve.points) {
            if (!errors) line.points.emplace_back(point.at, point.ms);
            if (errors && point.error) line.points.emplace_back(point.at, *point.error);
        }
        if (!line.points.empty()) plot.lines.push_back(std::move(line));
    }
    return {fmt::format("growth_{}_{}", growth.over, errors ? "error" : "time"),
            fmt::format("{} against {}, with fitted powers ({}, {}).", errors ? "Error" : "Time",
                        radius ? "the radius" : "the number of pixels", growth.scene, growth.conditions),
            line_svg(plot)};
}

bool has_errors(const Growth& growth) {
    return std::any_of(growth.curves.begin(), growth.curves.end(), [](const GrowthCurve& curve) {
        return std::any_of(curve.points.begin(), curve.points.end(),
                           [](const GrowthCurve::Point& point) { return point.error && *point.error > 0; });
    });
}

} // namespace

std::vector<EffectPlot> error_plots(const EffectFindings& effect) {
    std::vector<EffectPlot> plots;
    if (effect.error_is.empty()) return plots;
    plots.push_back(judged_plot(effect));
    if (effect.judged_by.empty()) return plots;
    const std::string other = effect.judged_by == "scene" ? "layer" : "scene";
    if (std::any_of(effect.levels.begin(), effect.levels.end(), [&](const Level& level) {
            return mean_over_scenes(level, other, &PictureError::relative_rmse).has_value();
        }))
        plots.push_back(other_plot(effect, other));
    plots.push_back(flip_plot(effect));
    return plots;
}

std::vector<EffectPlot> growth_plots(const EffectFindings& effect) {
    std::vector<EffectPlot> plots;
    for (const Growth& growth : effect.growth) {
        if (growth.curves.empty()) continue;
        plots.push_back(growth_plot(effect, growth, false));
        if (has_errors(growth)) plots.push_back(growth_plot(effect, growth, true));
    }
    return plots;
}

} // namespace postfx::host::study
