#include "budget_proof.hpp"

#include "measure/chain_truth.hpp"
#include "measure/level_trial.hpp"
#include "measure/measure.hpp"
#include "run/chain_runner.hpp"
#include "run/scene_view.hpp"
#include "terminal/interruption.hpp"
#include "terminal/progress_bar.hpp"
#include "truths/drawn_scene.hpp"

#include <image/metrics.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace postfx::host::study {
namespace {

/// A choice that takes another time than predicted is made again, as in a running chain: that may be of levels whose
/// times are off by another factor.
constexpr int corrections = 3;

/// One level for all, as one would set it by hand: an effect that ends below has its most exact one that is on a curve.
int uniform_level(const BudgetEntry& entry, const EffectInfo& effect, const std::string& level) {
    if (entry.role != BudgetEntry::Role::free) return entry.level;
    for (std::size_t i = 0; i < effect.levels.size(); ++i) {
        if (effect.levels[i].id == level) return static_cast<int>(i);
    }
    return entry.options.back().level;
}

class Prover {
public:
    Prover(StudyScene& scene, const Chain& chain, const Curves& curves, const BudgetProofOptions& options)
        : options_(options), chain_(chain), facts_(facts_of(scene.scene, scene.bounds, options.size, 0)),
          question_(budget_question(chain, curves, Planner().plan(chain, facts_))),
          renderer_(scene.scene, {.samples = 4}),
          scene_frame_(renderer_.render(facts_.width, facts_.height, 0, attachment_names())) {
        proof_.scene = scene.scene.name;
        proof_.size = options.size;
        proof_.rounds = options.rounds;
        const gl::ClockCheck clock = gl::check_clock();
        gpu_ = clock.timer_queries_honest;
        proof_.clock = gpu_ ? clock.text : "CPU time of all threads; " + clock.text;
        add_uniform_settings();
    }

    BudgetProof run(const ChainTruth& truth) {
        proof_.truths = truth.truths;
        proof_.truth_own_error = truth.own_error;
        measure_new_settings("one level for all");
        set_budgets();
        try_scene();
        for (ProvedBudget& budget : proof_.budgets)
            choose(budget, budget.ms, 1);
        measure_new_settings("levels chosen");
        for (int i = 0; i < corrections; ++i) {
            for (ProvedBudget& budget : proof_.budgets)
                correct(budget);
            measure_new_settings("levels chosen again");
        }
        measure_all_settings("all of them, in turns");
        for (ProvedBudget& budget : proof_.budgets)
            take_back(budget);
        find_time_scale();
        for (ProvedSetting& setting : proof_.settings)
            setting.error = relative_error(picture_of(setting), truth.picture).relative_rmse;
        compare();
        return std::move(proof_);
    }

private:
    std::size_t add(const std::string& name, const std::vector<int>& levels) {
        const auto same = std::find_if(proof_.settings.begin(), proof_.settings.end(),
                                       [&](const ProvedSetting& known) { return known.levels == levels; });
        if (same != proof_.settings.end()) return static_cast<std::size_t>(same - proof_.settings.begin());
        ProvedSetting& setting = proof_.settings.emplace_back();
        setting.name = name;
        setting.levels = levels;
        predict(setting);
        return proof_.settings.size() - 1;
    }

    void predict(ProvedSetting& setting) const {
        BudgetQuestion question = question_;
        for (std::size_t i = 0; i < setting.levels.size(); ++i)
            question.entries[i].level = setting.levels[i];
        setting.predicted_ms = question.ms();
        setting.predicted_error = question.error();
    }

    void add_uniform_settings() {
        for (const std::string& level : options_.uniform_levels) {
            if (!any_effect_has(level))
                throw Error(fmt::format("no effect of the chain has a level \"{}\"", level));
            std::vector<int> levels;
            for (std::size_t i = 0; i < chain_.entries.size(); ++i)
                levels.push_back(uniform_level(question_.entries[i], *chain_.entries[i].effect, level));
            add("all " + level, levels);
        }
        proof_.uniform_count = proof_.settings.size();
    }

    bool any_effect_has(const std::string& level) const {
        return std::any_of(chain_.entries.begin(), chain_.entries.end(), [&](const ChainEntry& entry) {
            const std::vector<LevelInfo>& levels = entry.effect->levels;
            return std::any_of(levels.begin(), levels.end(),
                               [&](const LevelInfo& info) { return info.id == level; });
        });
    }

    void measure_all_settings(const std::string& what) {
        measured_ = 0;
        measure_new_settings(what);
    }

    void measure_new_settings(const std::string& what) {
        std::vector<Case> cases;
        for (std::size_t i = measured_; i < proof_.settings.size(); ++i) {
            std::shared_ptr<ChainRunner> runner = runner_of(proof_.settings[i], Output::display);
            cases.push_back({proof_.settings[i].name, [this, runner] { draw(*runner); }});
        }
        if (cases.empty()) return;
        ProgressBar progress(proof_.scene + ", " + what, options_.rounds + warm_up_rounds);
        measure(cases, options_.rounds, progress, [] { StopOnInterrupt::check(); });
        for (std::size_t i = 0; i < cases.size(); ++i)
            proof_.settings[measured_ + i].ms = spread_of(cases[i].times(gpu_));
        measured_ = proof_.settings.size();
    }

    /// From the quickest of one level for all to the slowest, each the same multiple of the one before.
    void set_budgets() {
        const auto [first, last] =
            std::minmax_element(proof_.settings.begin(), proof_.settings.end(),
                                [](const auto& a, const auto& b) { return a.ms.median < b.ms.median; });
        const double least = first->ms.median, most = last->ms.median;
        for (int i = 0; i < options_.budgets; ++i)
            proof_.budgets.emplace_back().ms =
                least * std::pow(most / least, i / std::max(1.0, options_.budgets - 1.0));
    }

    /// As is done before a budget is met: errors are those that the scene tells.
    void try_scene() {
        TrialInputs inputs;
        inputs.draw_scene = [this](const std::vector<std::string>&) { return textures_of(scene_frame_); };
        inputs.frame.camera = facts_.camera;
        const Budget most = {Budget::Of::ms, proof_.budgets.back().ms};
        question_ = in_scene(question_, try_levels(chain_, question_, most, facts_, PlanOptions(), inputs));
        for (ProvedSetting& setting : proof_.settings)
            predict(setting);
    }

    /// Measured time as a multiple of what the curves predict.
    static double slowdown(const ProvedSetting& setting) { return setting.ms.median / setting.predicted_ms; }

    void find_time_scale() {
        std::vector<double> ratios;
        for (const ProvedSetting& setting : proof_.settings)
            ratios.push_back(slowdown(setting));
        proof_.time_scale = median(ratios);
    }

    void choose(ProvedBudget& budget, double limit_ms, double time_scale) {
        const Choice choice = LevelChooser(question_).best({Budget::Of::ms, limit_ms}, time_scale).choice;
        budget.chosen = add(text_of(choice.levels), choice.levels);
    }

    bool is_over(const ProvedBudget& budget, std::size_t setting) const {
        return proof_.settings[setting].ms.median > keeping_rule.tolerated * budget.ms;
    }

    /// By what the choice took, as BudgetKeeper does.
    void correct(ProvedBudget& budget) {
        const std::size_t before = budget.chosen;
        const bool over = is_over(budget, before);
        if (!over) budget.kept = before;
        choose(budget, (over ? keeping_rule.aim : keeping_rule.headroom) * budget.ms,
               slowdown(proof_.settings[before]));
        const double better = keeping_rule.noticeably_better * proof_.settings[before].predicted_error;
        if (!over && proof_.settings[budget.chosen].predicted_error > better) budget.chosen = before;
    }

    /// A raise that takes too long does not last.
    void take_back(ProvedBudget& budget) const {
        if (budget.kept && is_over(budget, budget.chosen)) budget.chosen = *budget.kept;
    }

    void compare() {
        for (ProvedBudget& budget : proof_.budgets) {
            const double allowed = std::max(budget.ms, proof_.settings[budget.chosen].ms.median);
            for (std::size_t i = 0; i < proof_.uniform_count; ++i) {
                const ProvedSetting& setting = proof_.settings[i];
                if (setting.ms.median > allowed) continue;
                if (!budget.uniform || setting.error < proof_.settings[*budget.uniform].error)
                    budget.uniform = i;
            }
        }
    }

    std::string text_of(const std::vector<int>& levels) const {
        std::vector<std::string> parts;
        for (std::size_t i = 0; i < levels.size(); ++i) {
            if (question_.entries[i].role != BudgetEntry::Role::free) continue;
            const ChainEntry& entry = chain_.entries[i];
            parts.push_back(fmt::format("{} {}", entry.name,
                                        entry.effect->levels[static_cast<std::size_t>(levels[i])].id));
        }
        return fmt::format("{}", fmt::join(parts, ", "));
    }

    std::shared_ptr<ChainRunner> runner_of(const ProvedSetting& setting, Output output) const {
        Chain chain = chain_;
        for (std::size_t i = 0; i < chain.entries.size(); ++i)
            chain.entries[i].level = setting.levels[i];
        return std::make_shared<ChainRunner>(std::move(chain), facts_, PlanOptions{.output = output});
    }

    void draw(ChainRunner& runner) const {
        FrameInputs frame;
        frame.camera = facts_.camera;
        runner.run(textures_of(scene_frame_), frame, Timing::off);
    }

    Image64 picture_of(const ProvedSetting& setting) const {
        StopOnInterrupt::check();
        const std::shared_ptr<ChainRunner> runner = runner_of(setting, Output::linear);
        draw(*runner);
        return light_of(runner->executor().read_picture());
    }

    BudgetProofOptions options_;
    Chain chain_;
    SceneFacts facts_;
    BudgetQuestion question_;
    SceneRenderer renderer_;
    SceneFrame scene_frame_;
    bool gpu_ = false;
    std::size_t measured_ = 0; ///< settings, the first of them
    BudgetProof proof_;
};

} // namespace

double ProvedBudget::ratio(const std::vector<ProvedSetting>& settings) const {
    return settings[chosen].error / settings[uniform.value()].error;
}

std::size_t BudgetProof::compared() const {
    return static_cast<std::size_t>(
        std::count_if(budgets.begin(), budgets.end(),
                      [](const ProvedBudget& budget) { return budget.uniform.has_value(); }));
}

std::size_t BudgetProof::worse_than(double ratio) const {
    return compared() - at_most(ratio);
}

std::size_t BudgetProof::at_most(double ratio) const {
    return static_cast<std::size_t>(
        std::count_if(budgets.begin(), budgets.end(), [&](const ProvedBudget& budget) {
            return budget.uniform && budget.ratio(settings) <= ratio;
        }));
}

BudgetProof prove_budgets(StudyScene& scene, const Chain& chain, const Curves& curves,
                          const BudgetProofOptions& options, const std::filesystem::path& truth_store) {
    Prover prover(scene, chain, curves, options);
    const ChainTruth truth = chain_truth(
        chain,
        {.scene = scene.scene, .width = options.size.width, .height = options.size.height, .entry = {}},
        truth_store);
    return prover.run(truth);
}

nlohmann::ordered_json budget_proof_json(const BudgetProof& proof) {
    nlohmann::ordered_json json = {{"scene", proof.scene},
                                   {"size", fmt::format("{}x{}", proof.size.width, proof.size.height)},
                                   {"clock", proof.clock},
                                   {"rounds", proof.rounds},
                                   {"time_scale", proof.time_scale},
                                   {"truths", proof.truths},
                                   {"truth_own_error", proof.truth_own_error},
                                   {"settings", nlohmann::ordered_json::array()},
                                   {"budgets", nlohmann::ordered_json::array()}};
    for (const ProvedSetting& setting : proof.settings)
        json["settings"].push_back({{"name", setting.name},
                                    {"predicted_ms", setting.predicted_ms * proof.time_scale},
                                    {"ms", setting.ms.median},
                                    {"p10", setting.ms.p10},
                                    {"p90", setting.ms.p90},
                                    {"predicted_error", setting.predicted_error},
                                    {"error", setting.error}});
    for (const ProvedBudget& budget : proof.budgets) {
        nlohmann::ordered_json item = {{"ms", budget.ms},
                                       {"chosen", proof.settings[budget.chosen].name},
                                       {"uniform", nullptr},
                                       {"ratio", nullptr}};
        if (budget.uniform) {
            item["uniform"] = proof.settings[*budget.uniform].name;
            item["ratio"] = budget.ratio(proof.settings);
        }
        json["budgets"].push_back(std::move(item));
    }
    return json;
}

} // namespace postfx::host::study
