#include "tables.hpp"

#include "pareto.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace postfx::host::study {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}
Json number(const std::optional<double>& value) {
    return value ? number(*value) : Json();
}

Json spread_json(const Spread& spread) {
    return {{"median", spread.median}, {"p10", spread.p10}, {"p90", spread.p90}, {"rounds", spread.rounds}};
}

Json time_json(const TimeCurve& curve) {
    return {{"fixed_ms", curve.fixed_ms},
            {"ms_per_megapixel", curve.ms_per_megapixel},
            {"exponent", curve.exponent}};
}

Json scene_json(const SceneFindings& scene) {
    Json truths = Json::array();
    for (const TruthFacts& truth : scene.truths) {
        truths.push_back({{"kind", truth.kind},
                          {"description", truth.description},
                          {"samples", truth.samples},
                          {"own_error", number(truth.own_error)},
                          {"compared", truth.statistics ? "statistics" : "pixels"}});
    }
    return {{"name", scene.name},
            {"description", scene.description},
            {"truths", truths},
            {"no_truth", scene.no_truth},
            {"inputs_error", number(scene.inputs_error)}};
}

Json level_on_scene_json(const LevelOnScene& level, const std::string& scene) {
    Json errors = Json::object(), costs = Json::array();
    for (const auto& [kind, error] : level.errors)
        errors[kind] = {{"relative_rmse", number(error.relative_rmse)}, {"flip", number(error.flip)}};
    for (const Cost& cost : level.costs) {
        costs.push_back({{"width", cost.width},
                         {"height", cost.height},
                         {"ms", spread_json(cost.ms)},
                         {"copies", spread_json(cost.copies)}});
    }
    return {{"scene", scene},
            {"errors", errors},
            {"costs", costs},
            {"taps_per_pixel", number(level.taps)},
            {"skipped", level.skipped}};
}

Json level_json(const EffectFindings& effect, const Level& level) {
    Json scenes = Json::array(), metrics = Json::object();
    for (std::size_t s = 0; s < effect.scenes.size(); ++s)
        scenes.push_back(level_on_scene_json(level.scenes[s], effect.scenes[s].name));
    for (std::size_t m = 0; m < effect.metrics.size(); ++m)
        metrics[effect.metrics[m].name] = number(level.metrics[m]);
    return {{"level", level.id},
            {"help", level.help},
            {"error", number(level.error)},
            {"ms", spread_json(level.ms)},
            {"time", time_json(level.time)},
            {"dominated_by", level.dominated_by},
            {"on_hull", level.on_hull},
            {"step_to_next", level.step_to_next},
            {"passes", level.passes},
            {"bytes_written_per_pixel", level.bytes_written},
            {"bytes_read_per_pixel", level.bytes_read},
            {"taps_per_pixel", number(level.taps)},
            {"metrics", metrics},
            {"scenes", scenes}};
}

Json growth_json(const Growth& growth) {
    Json curves = Json::array();
    for (const GrowthCurve& curve : growth.curves) {
        Json points = Json::array();
        for (const GrowthCurve::Point& point : curve.points)
            points.push_back({{"at", point.at}, {"ms", point.ms}, {"error", number(point.error)}});
        curves.push_back({{"level", curve.level},
                          {"time_exponent", number(curve.time_exponent)},
                          {"error_exponent", number(curve.error_exponent)},
                          {"points", points}});
    }
    return {{"over", growth.over},         {"scene", growth.scene},
            {"truth", growth.truth},       {"conditions", growth.conditions},
            {"left_out", growth.left_out}, {"curves", curves}};
}

Json effect_json(const EffectFindings& effect) {
    Json scenes = Json::array(), metrics = Json::array(), levels = Json::array(), growth = Json::array(),
         curve = Json::array();
    for (const SceneFindings& scene : effect.scenes)
        scenes.push_back(scene_json(scene));
    for (const MetricFacts& metric : effect.metrics) {
        metrics.push_back({{"name", metric.name},
                           {"unit", metric.unit},
                           {"help", metric.help},
                           {"stands_for_error", metric.stands_for_error}});
    }
    for (const Level& level : effect.levels)
        levels.push_back(level_json(effect, level));
    for (const Growth& item : effect.growth)
        growth.push_back(growth_json(item));
    for (const std::size_t i : curve_of(effect))
        curve.push_back(effect.levels[i].id);
    return {{"id", effect.id},
            {"stage", effect.stage},
            {"values", effect.values},
            {"picture_size", effect.picture_size},
            {"judged_by", effect.judged_by},
            {"error_is", effect.error_is},
            {"own_error", effect.own_error()},
            {"inputs_error", number(effect.inputs_error())},
            {"curve", curve},
            {"metrics", metrics},
            {"scenes", scenes},
            {"levels", levels},
            {"growth", growth},
            {"notes", effect.notes},
            {"seconds", effect.seconds}};
}

} // namespace

nlohmann::ordered_json findings_json(const Findings& findings) {
    const Conditions& conditions = findings.conditions;
    Json json = {{"program", conditions.program},
                 {"command", conditions.command},
                 {"device", conditions.device},
                 {"driver", conditions.driver},
                 {"clock", conditions.clock},
                 {"time_sizes", conditions.time_sizes},
                 {"pixels_per_degree", conditions.pixels_per_degree},
                 {"working_format", conditions.working_format},
                 {"base", time_json(findings.base)},
                 {"effects", Json::array()},
                 {"failures", Json::array()}};
    for (const EffectFindings& effect : findings.effects)
        json["effects"].push_back(effect_json(effect));
    for (const Failure& failure : findings.failures)
        json["failures"].push_back({{"effect", failure.effect}, {"message", failure.message}});
    return json;
}

} // namespace postfx::host::study
