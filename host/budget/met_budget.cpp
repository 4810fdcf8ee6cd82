#include "met_budget.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace postfx::host {
namespace {

std::vector<std::string> names_of(const LevelTrial& trial) {
    std::vector<std::string> names;
    for (const auto& [name, distances] : trial.distances)
        names.push_back(name);
    return names;
}

} // namespace

std::string MetBudget::text() const {
    std::string text = budget_text(budget, question, answer);
    text += fmt::format("  curves: {} ({}; clock: {})\n", curves.file.string(), curves.curves.device,
                        curves.curves.clock);
    if (!curves.note.empty()) text += fmt::format("  {}\n", curves.note);
    text += trial.distances.empty()
                ? "  errors: those of the curves, of other scenes\n"
                : fmt::format("  errors: tried in this scene: {}\n", fmt::join(names_of(trial), ", "));
    return text;
}

std::string MetBudget::json() const {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(budget_json(budget, question, answer));
    json["curves"] = {{"file", curves.file.string()},
                      {"device", curves.curves.device},
                      {"driver", curves.curves.driver},
                      {"clock", curves.curves.clock},
                      {"note", curves.note}};
    json["tried"] = names_of(trial);
    return json.dump(2);
}

std::optional<MetBudget> meet_budget(Chain& chain, const SceneFacts& facts, const PlanOptions& options,
                                     const BudgetSource& source, const TrialInputs& inputs) {
    if (!chain.budget) return std::nullopt;
    FoundCurves found = find_curves(source.curves);
    BudgetQuestion question = budget_question(chain, found.curves, Planner().plan(chain, facts, options));
    LevelTrial trial;
    if (!source.by_curves) {
        trial = try_levels(chain, question, *chain.budget, facts, options, inputs);
        question = in_scene(std::move(question), trial);
    }
    BudgetAnswer answer = LevelChooser(question).best(*chain.budget);
    apply(answer.choice, chain);
    return MetBudget{*chain.budget, std::move(found), std::move(trial), std::move(question),
                     std::move(answer)};
}

} // namespace postfx::host
