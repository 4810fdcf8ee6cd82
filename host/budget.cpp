#include "budget.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace postfx::host {

std::string MetBudget::text() const {
    std::string text = budget_text(budget, question, answer);
    text += fmt::format("  curves: {} ({}; clock: {})\n", curves.file.string(), curves.curves.device,
                        curves.curves.clock);
    if (!curves.note.empty()) text += fmt::format("  {}\n", curves.note);
    return text;
}

std::string MetBudget::json() const {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(budget_json(budget, question, answer));
    json["curves"] = {{"file", curves.file.string()},
                      {"device", curves.curves.device},
                      {"driver", curves.curves.driver},
                      {"clock", curves.curves.clock},
                      {"note", curves.note}};
    return json.dump(2);
}

std::optional<MetBudget> meet_budget(Chain& chain, const Facts& facts, const std::filesystem::path& curves) {
    if (!chain.budget) return std::nullopt;
    FoundCurves found = find_curves(curves);
    BudgetQuestion question = budget_question(chain, found.curves, Planner().plan(chain, facts));
    BudgetAnswer answer = LevelChooser(question).best(*chain.budget);
    apply(answer.choice, chain);
    return MetBudget{*chain.budget, std::move(found), std::move(question), std::move(answer)};
}

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
    return budget_question(runner.chain(), met_.curves.curves, runner.plan());
}

std::uint32_t RunningBudget::run(ChainRunner& runner, const Textures& textures, const FrameInputs& frame) {
    keeper_.follow(question_of(runner));
    timer_.begin();
    const std::uint32_t picture = runner.run(textures, frame, Timing::off);
    timer_.end();
    const std::optional<double> ms = timer_.ms();
    if (!ms) return picture;
    if (const auto choice = keeper_.frame(gl::HostTime::now().wall_ms / 1000, *ms))
        apply(*choice, runner.chain());
    return picture;
}

void RunningBudget::choose_again(ChainRunner& runner) {
    const LevelChooser chooser(question_of(runner));
    apply(chooser.best(met_.budget, keeper_.correction()).choice, runner.chain());
    runner.replan(runner.facts());
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
