// Is it worth to ask for a budget? A chain with the levels that a budget chooses, against the same chain with one level
// everywhere: both measured in turns on a scene, both compared with the truth of the chain. Chosen is as in a running
// chain: by the scene's trial of levels, and again by what the choice then took. [GL thread]
#pragma once

#include "study/findings.hpp"
#include "view.hpp"

#include <postfx/budget.hpp>
#include <postfx/curves.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace postfx::host::study {

/// A chain with certain levels.
struct ProvedSetting {
    std::string name; ///< "all low", or the levels that were chosen
    std::vector<int> levels;
    double predicted_ms = 0, predicted_error = 0;
    Spread ms;
    double error = 0; ///< relative RMSE against the chain's truth, linear light
};

/// A budget of time and what became of it.
struct ProvedBudget {
    double ms = 0;
    std::size_t chosen = 0;          ///< into settings
    std::optional<std::size_t> kept; ///< the last one chosen before it that took no longer than was allowed
    std::optional<std::size_t>
        uniform; ///< the best of those with one level that took no longer than was allowed or than
                 ///< the chosen one took; none fits: nothing
    /// Error of the chosen one as a multiple of the uniform one's.
    double ratio(const std::vector<ProvedSetting>& settings) const;
};

struct BudgetProof {
    std::string scene, clock;
    Size size;
    int rounds = 0;
    double time_scale = 1; ///< measured time as a multiple of what the curves predict, median of all settings
    double truth_own_error = 0;
    std::vector<std::string> truths;
    std::vector<ProvedSetting> settings; ///< uniform ones first
    std::size_t uniform_count = 0;
    std::vector<ProvedBudget> budgets;

    std::size_t compared() const;               ///< budgets that a uniform setting fits too
    std::size_t worse_than(double ratio) const; ///< how many of them have a ratio above it
    std::size_t at_most(double ratio) const;    ///< how many have one up to it
};

struct BudgetProofOptions {
    Size size{640, 360};
    std::vector<std::string> uniform_levels = {"low", "medium", "high", "ultra"};
    int budgets =
        12; ///< from the quickest to the slowest uniform setting, each the same multiple of the one before
    int rounds = 11;
};

/// Every enabled effect of the chain must have a truth of its pixels. Throws Error, Interrupted.
BudgetProof prove_budgets(StudyScene& scene, const Chain& chain, const Curves& curves,
                          const BudgetProofOptions& options, const std::filesystem::path& truth_store);

nlohmann::ordered_json budget_proof_json(const BudgetProof& proof);

} // namespace postfx::host::study
