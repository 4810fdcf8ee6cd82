// Chains that ask for a budget: levels are chosen before anything is planned for drawing.
#pragma once

#include "device_curves.hpp"

#include "measure/level_trial.hpp"

#include <postfx/budget.hpp>

#include <optional>
#include <string>

namespace postfx::host {

/// What is known of levels when a budget is met.
struct BudgetSource {
    std::string curves;     ///< file; "" = those of the current OpenGL context's device
    bool by_curves = false; ///< errors are those of the curves: levels are not tried in the scene
};

/// What a chain's budget bought.
struct MetBudget {
    Budget budget;
    FoundCurves curves;
    LevelTrial trial; ///< of the levels in the scene; empty: they were not tried
    BudgetQuestion question;
    BudgetAnswer answer;

    /// budget_text(), and where times and errors are from.
    std::string text() const;
    /// budget_json() with "curves": {"file", "device", "driver", "clock", "note"} and "tried": names of effects whose
    /// levels were tried in the scene.
    std::string json() const;
};

/// Set the chain's levels to what its budget buys in a picture of these facts and options; nothing happens to a chain
/// without a budget.
std::optional<MetBudget> meet_budget(Chain& chain, const SceneFacts& facts, const PlanOptions& options,
                                     const BudgetSource& source, const TrialInputs& inputs);

} // namespace postfx::host
