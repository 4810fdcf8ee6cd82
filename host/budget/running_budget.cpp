#include "running_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace postfx::host {
ChainTimer::ChainTimer() {
    if (gl::check_clock().timer_queries_honest) ring_.emplace(1);
}

void ChainTimer::begin() {
    if (ring_) {
        ring_->begin_frame();
        ring_->mark();
        return;
    }
    glFinish();
    start_ = gl::HostTime::now();
}

void ChainTimer::end() {
    if (ring_) {
        ring_->mark();
        ring_->end_frame();
        return;
    }
    glFinish();
    host_ms_ = gl::HostTime::now().cpu_ms - start_.cpu_ms;
}

std::optional<double> ChainTimer::ms() {
    if (!ring_) return host_ms_;
    const std::vector<double>& latest = ring_->latest();
    return latest.empty() ? std::nullopt : std::optional(latest.front());
}

RunningBudget::RunningBudget(MetBudget met, const ChainRunner& runner)
    : met_(std::move(met)), keeper_(met_.budget) {
    keeper_.follow(question_of(runner));
}

BudgetQuestion RunningBudget::question_of(const ChainRunner& runner) const {
    return in_scene(budget_question(runner.chain(), met_.curves.curves, runner.plan()), met_.trial);
}

std::vector<std::string> RunningBudget::attachments(const ChainRunner& runner) const {
    std::vector<std::string> all = runner.attachments();
    if (!next_change_) return all;
    Chain chain = runner.chain();
    apply(next_change_->choice, chain);
    for (const std::string& name : Planner().plan(chain, runner.facts(), runner.options()).attachments) {
        if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
    return all;
}

std::uint32_t RunningBudget::run(ChainRunner& runner, const Textures& textures, const FrameInputs& frame) {
    if (next_change_) return change_levels(runner, textures, frame);
    keeper_.follow(question_of(runner));
    timer_.begin();
    const std::uint32_t drawn = runner.run(textures, frame, Timing::off);
    timer_.end();
    if (const std::optional<double> ms = timer_.ms())
        next_change_ = keeper_.frame(gl::HostTime::now().wall_ms / 1000, *ms);
    return cross_fade_.show(drawn, runner.facts().width, runner.facts().height);
}

std::uint32_t RunningBudget::change_levels(ChainRunner& runner, const Textures& textures,
                                           const FrameInputs& frame) {
    const LevelChange change = *std::exchange(next_change_, std::nullopt);
    const int width = runner.facts().width, height = runner.facts().height;
    if (change.frames > 1) {
        const std::uint32_t before = runner.run(textures, frame, Timing::off);
        cross_fade_.begin(cross_fade_.show(before, width, height), width, height, change.frames);
    }
    apply(change.choice, runner.chain());
    runner.replan(runner.facts());
    return cross_fade_.show(runner.run(textures, frame, Timing::off), width, height);
}

void RunningBudget::choose_again(ChainRunner& runner) {
    next_change_.reset();
    const LevelChooser chooser(question_of(runner));
    apply(chooser.best(met_.budget, keeper_.correction()).choice, runner.chain());
    runner.replan(runner.facts());
}

void RunningBudget::try_again(ChainRunner& runner, const TrialInputs& inputs) {
    const BudgetQuestion by_curves = budget_question(runner.chain(), met_.curves.curves, runner.plan());
    met_.trial = try_levels(runner.chain(), by_curves, met_.budget, runner.facts(), runner.options(), inputs);
    choose_again(runner);
}

std::string RunningBudget::text(const ChainRunner& runner) const {
    const BudgetQuestion question = question_of(runner);
    std::string levels;
    for (const BudgetEntry& entry : question.entries) {
        if (entry.options.empty() || entry.level_id.empty()) continue;
        levels += fmt::format("{}{} {}", levels.empty() ? "" : ", ", entry.name, entry.level_id);
    }
    return fmt::format("budget: {} {:.3g}; error {:.3g}; {}\n{}", budget_word(met_.budget.of),
                       met_.budget.limit, question.error(), levels, keeper_.text());
}

} // namespace postfx::host
