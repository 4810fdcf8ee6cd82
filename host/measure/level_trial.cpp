#include "level_trial.hpp"

#include "run/chain_runner.hpp"
#include "run/scene_view.hpp"
#include "terminal/progress_bar.hpp"
#include "truths/drawn_scene.hpp"

#include <image/metrics.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

class Tryer {
public:
    Tryer(const Chain& chain, const BudgetQuestion& question, const SceneFacts& facts,
          const PlanOptions& options, const TrialInputs& inputs, std::vector<std::size_t> counts)
        : question_(question), counts_(std::move(counts)), inputs_(inputs),
          runner_(cheapest(chain), facts, options), textures_(inputs.draw_scene(attachments_of_all())),
          progress_("trying levels", 1 + pictures_of_entries()) {}

    LevelTrial run() {
        const Image64 cheapest = draw();
        LevelTrial trial;
        for (std::size_t e = 0; e < counts_.size(); ++e) {
            if (counts_[e] < 2) continue;
            std::vector<double> distances = distances_of(e, cheapest);
            const bool finite = std::all_of(distances.begin(), distances.end(),
                                            [](double distance) { return std::isfinite(distance); });
            if (finite) trial.distances[question_.entries[e].name] = std::move(distances);
        }
        return trial;
    }

private:
    /// Every effect that is chosen for at its first option, none from the tone map on.
    Chain cheapest(Chain chain) const {
        for (std::size_t e = 0; e < chain.entries.size(); ++e) {
            ChainEntry& entry = chain.entries[e];
            if (counts_[e] > 0) entry.level = question_.entries[e].options.front().level;
            if (entry.effect->stage != EffectStage::scene) entry.enabled = false;
        }
        return chain;
    }

    std::vector<double> distances_of(std::size_t e, const Image64& cheapest) {
        const std::vector<LevelOption>& options = question_.entries[e].options;
        const std::size_t last = counts_[e] - 1;
        const Image64 best = draw_at(e, options[last].level);
        std::vector<double> distances(counts_[e], 0.0);
        distances.front() = relative_error(cheapest, best).relative_rmse;
        for (std::size_t i = 1; i < last; ++i)
            distances[i] = relative_error(draw_at(e, options[i].level), best).relative_rmse;
        set_level(e, options.front().level);
        return distances;
    }

    Image64 draw_at(std::size_t e, int level) {
        set_level(e, level);
        return draw();
    }

    Image64 draw() {
        runner_.run(textures_, inputs_.frame, Timing::off);
        progress_.advance();
        return light_of(runner_.executor().read_picture());
    }

    void set_level(std::size_t e, int level) {
        runner_.chain().entries[e].level = level;
        runner_.replan(runner_.facts());
    }

    /// What any of the levels reads.
    std::vector<std::string> attachments_of_all() {
        std::vector<std::string> all = runner_.attachments();
        for (std::size_t e = 0; e < counts_.size(); ++e) {
            Chain chain = runner_.chain();
            for (std::size_t i = 1; i < counts_[e]; ++i) {
                chain.entries[e].level = question_.entries[e].options[i].level;
                for (const std::string& name :
                     Planner().plan(chain, runner_.facts(), runner_.options()).attachments) {
                    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
                }
            }
        }
        return all;
    }

    int pictures_of_entries() const {
        std::size_t count = 0;
        for (const std::size_t options : counts_)
            count += std::max<std::size_t>(options, 1) - 1;
        return static_cast<int>(count);
    }

    const BudgetQuestion& question_;
    std::vector<std::size_t> counts_; ///< of options that are tried, by entry
    const TrialInputs& inputs_;
    ChainRunner runner_;
    Textures textures_;
    ProgressBar progress_;
};

} // namespace

LevelTrial try_levels(const Chain& chain, const BudgetQuestion& question, const Budget& budget,
                      const SceneFacts& facts, PlanOptions options, const TrialInputs& inputs) {
    options.output = Output::linear;
    options.fold = false; // levels share more programs, and the next trial finds them kept
    std::vector<std::size_t> counts = options_to_try(question, budget);
    for (std::size_t e = 0; e < counts.size(); ++e) {
        if (chain.entries[e].effect->stage != EffectStage::scene) counts[e] = 0;
    }
    const bool any = std::any_of(counts.begin(), counts.end(), [](std::size_t count) { return count > 1; });
    return any ? Tryer(chain, question, facts, options, inputs, std::move(counts)).run() : LevelTrial{};
}

TrialInputs trial_inputs(SceneRenderer& renderer, const SceneFacts& facts, double time) {
    TrialInputs inputs;
    inputs.frame.camera = facts.camera;
    inputs.frame.time = time;
    inputs.draw_scene = [&renderer, facts, time](const std::vector<std::string>& attachments) {
        return textures_of(
            renderer.render(facts.width, facts.height, time, attachments, CameraOverride{facts.camera, {}}));
    };
    return inputs;
}

} // namespace postfx::host
