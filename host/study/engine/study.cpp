#include "study.hpp"

#include "growth.hpp"
#include "thumbnails.hpp"

#include "input/open_scene.hpp"
#include "run/scene_view.hpp"
#include "study/fit.hpp"
#include "study/pareto.hpp"
#include "terminal/interruption.hpp"
#include "terminal/progress_bar.hpp"

#include <gl/clock.hpp>
#include <image/metrics.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace postfx::host::study {
namespace {

/// The entry at each of its levels.
std::vector<ChainEntry> every_level(const ChainEntry& entry) {
    std::vector<ChainEntry> entries(std::max<std::size_t>(entry.effect->levels.size(), 1), entry);
    for (std::size_t i = 0; i < entries.size(); ++i)
        entries[i].level = entry.effect->levels.empty() ? entry.level : static_cast<int>(i);
    return entries;
}

std::vector<Level> levels_of(const EffectInfo& effect) {
    std::vector<Level> levels;
    for (const LevelInfo& info : effect.levels) {
        Level& level = levels.emplace_back();
        level.id = info.id;
        level.help = info.help;
    }
    if (levels.empty()) levels.emplace_back();
    return levels;
}

/// The kind of truth that the order of levels is from; "" when there is none of pixels in every scene.
std::string judge_of(const std::vector<SceneFindings>& scenes, const std::string& wish) {
    std::vector<std::string> kinds = {wish, "scene", "layer"};
    for (const std::string& kind : kinds) {
        const bool everywhere = std::all_of(scenes.begin(), scenes.end(), [&](const SceneFindings& scene) {
            const TruthFacts* truth = scene.find_truth(kind);
            return truth && !truth->statistics;
        });
        if (!kind.empty() && everywhere) return kind;
    }
    return "";
}

/// None, and a note why, if the shaders can't count them.
std::optional<double> counted_taps(const View& view, const ChainEntry& entry,
                                   std::vector<std::string>& notes) {
    try {
        return taps_of(view, entry);
    } catch (const Error& error) {
        const std::string note = fmt::format("taps are not known: {}", error.what());
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
        return std::nullopt;
    }
}

std::string error_text(const EffectFindings& findings) {
    if (!findings.judged_by.empty()) {
        return findings.judged_by == "scene" ? "relative RMSE from the truth of the scene"
                                             : "relative RMSE from the best that its inputs allow";
    }
    for (const MetricFacts& metric : findings.metrics) {
        if (metric.stands_for_error) return metric.name + ": " + metric.help;
    }
    return "";
}

} // namespace

Study::Study(const Catalog& catalog, Spec spec, StudyOptions options)
    : catalog_(catalog), spec_(std::move(spec)), options_(std::move(options)) {}

std::shared_ptr<StudyScene> Study::scene(const std::string& name) {
    std::shared_ptr<StudyScene>& found = scenes_[name];
    if (!found) found = std::make_shared<StudyScene>(open_known_scene(name));
    return found;
}

Size Study::size_for(const EffectSpec& spec) const {
    if (options_.picture) return *options_.picture;
    return spec.size.empty() ? usual_picture : parse_size(spec.size);
}

EffectFindings Study::run(const EffectInfo& effect) {
    at_hand_.clear(); // of one that failed
    views_.clear();
    pictures_.clear();
    const double start_ms = gl::HostTime::now().wall_ms;
    const EffectSpec spec = spec_.of(effect);
    const std::vector<ChainEntry> entries = every_level(entry_of(catalog_, effect.id, spec));
    const Size picture = size_for(spec);
    EffectFindings findings;
    findings.id = effect.id;
    findings.help = effect.help;
    findings.stage = stage_word(effect.stage);
    findings.values = spec.values;
    findings.picture_size = fmt::format("{}x{}", picture.width, picture.height);
    findings.metrics = metrics_of(effect.id);
    findings.levels = levels_of(effect);
    for (const std::string& name : options_.scenes.empty() ? spec.scenes : options_.scenes) {
        at_hand_.push_back(scene(name));
        SceneFindings& scene_findings = findings.scenes.emplace_back();
        scene_findings.name = at_hand_.back()->scene.name;
        scene_findings.description = at_hand_.back()->scene.description;
        views_.push_back(std::make_unique<View>(*at_hand_.back(), effect, picture, 4));
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        findings.levels[i].scenes.resize(findings.scenes.size());
        findings.levels[i].metrics = measure_metrics(findings.metrics, entries[i], findings.notes);
    }
    find_errors(findings, entries, spec.judged_by);
    find_times(findings, effect, entries);
    conclude(findings);
    find_steps(findings);
    views_.clear();
    pictures_.clear();
    if (options_.growth) {
        const bool named = spec.radius && !spec.radius->scene.empty();
        const std::shared_ptr<StudyScene> grown = named ? scene(spec.radius->scene) : at_hand_.front();
        GrowthInputs inputs{.scene = *grown,
                            .entries = entries,
                            .growing_entries = every_level(growing_entry_of(catalog_, effect.id, spec)),
                            .radius = spec.radius,
                            .judged_by = findings.judged_by,
                            .picture = options_.picture.value_or(usual_picture),
                            .time_size = options_.time_sizes.front(),
                            .truths = options_.truths,
                            .times = options_.times,
                            .limit_ms = 1000 * options_.growth_seconds};
        findings.growth = find_growth(inputs, findings);
    }
    findings.seconds = (gl::HostTime::now().wall_ms - start_ms) / 1000;
    return findings;
}

void Study::find_errors(EffectFindings& findings, const std::vector<ChainEntry>& entries,
                        const std::string& judged_by) {
    const std::string& id = entries.front().effect->id;
    const auto registered = truths_of(id);
    if (registered.empty()) findings.notes.emplace_back("no truth of it is known: only times were measured");
    std::vector<Truths> truths;
    for (std::size_t s = 0; s < findings.scenes.size(); ++s) {
        SceneFindings& scene_findings = findings.scenes[s];
        truths.push_back(
            sum_up_truths(registered, at_hand_[s]->scene, *views_[s], entries.front(), options_.truths));
        for (const SummedTruth& truth : truths[s].summed)
            scene_findings.truths.push_back(truth.facts);
        scene_findings.no_truth = truths[s].missing;
        const SummedTruth *whole = truths[s].find("scene"), *layer = truths[s].find("layer");
        if (whole && layer && !whole->facts.statistics && !layer->facts.statistics)
            scene_findings.inputs_error = relative_error(layer->picture, whole->picture).relative_rmse;
    }
    findings.judged_by = judge_of(findings.scenes, judged_by);
    findings.error_is = error_text(findings);
    for (std::size_t s = 0; s < findings.scenes.size(); ++s) {
        ProgressBar progress(fmt::format("{} in {}, errors", id, findings.scenes[s].name),
                             static_cast<int>(entries.size()));
        pictures_.emplace_back();
        for (std::size_t i = 0; i < entries.size(); ++i) {
            StopOnInterrupt::check();
            pictures_[s].push_back(picture_of(entries[i], *views_[s]));
            findings.levels[i].scenes[s].skipped = pictures_[s][i].skipped;
            for (const SummedTruth& truth : truths[s].summed) {
                if (truth.facts.statistics) continue;
                findings.levels[i].scenes[s].errors[truth.facts.kind] =
                    error_of(pictures_[s][i].light, truth.picture, *views_[s]);
            }
            progress.advance();
        }
    }
    const SummedTruth* judge = truths.front().find(findings.judged_by);
    add_thumbnails(findings, *views_.front(), pictures_.front(), judge ? &judge->picture : nullptr);
}

void Study::find_steps(EffectFindings& findings) {
    const std::vector<std::size_t> curve = curve_of(findings);
    for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
        double sum = 0;
        for (std::size_t s = 0; s < pictures_.size(); ++s)
            sum +=
                mean_of(flip_map(pictures_[s][curve[k]].light, pictures_[s][curve[k + 1]].light, *views_[s]));
        findings.levels[curve[k]].step_to_next = sum / static_cast<double>(pictures_.size());
    }
}

void Study::find_times(EffectFindings& findings, const EffectInfo& effect,
                       const std::vector<ChainEntry>& entries) {
    for (std::size_t s = 0; s < findings.scenes.size(); ++s) {
        for (const Size& size : options_.time_sizes) {
            const View view(*at_hand_[s], effect, size, 1);
            const TimedEntries timed =
                measure_entries(view, entries, options_.times,
                                fmt::format("{} in {}, times at {}x{}", effect.id, findings.scenes[s].name,
                                            size.width, size.height));
            base_.emplace_back(1e-6 * size.width * size.height, timed.base_ms.median);
            for (std::size_t i = 0; i < entries.size(); ++i) {
                LevelOnScene& level = findings.levels[i].scenes[s];
                level.costs.push_back(timed.costs[i]);
                if (&size != &options_.time_sizes.front()) continue;
                StopOnInterrupt::check();
                level.taps = counted_taps(view, entries[i], findings.notes);
                if (s > 0) continue;
                const Work work = work_of(view, entries[i]);
                findings.levels[i].passes = work.passes;
                findings.levels[i].bytes_written = work.bytes_written;
                findings.levels[i].bytes_read = work.bytes_read;
            }
        }
    }
}

TimeCurve Study::base() const {
    return fit_time(base_);
}

} // namespace postfx::host::study
