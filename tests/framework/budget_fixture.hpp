// Questions made by hand and at random, and the slow way to answer them.
#pragma once

#include <postfx/budget.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace budget_fixture {

using postfx::Budget;
using postfx::BudgetEntry;
using postfx::BudgetQuestion;
using postfx::Choice;
using postfx::LevelOption;

inline constexpr Budget within_ms(double limit) {
    return {Budget::Of::ms, limit};
}
inline constexpr Budget within_error(double limit) {
    return {Budget::Of::error, limit};
}

inline BudgetEntry entry(const std::string& name, std::vector<LevelOption> options, int level = 0) {
    BudgetEntry made;
    made.name = made.effect = name;
    made.level = level;
    made.options = std::move(options);
    if (!made.options.empty()) made.level_id = made.options.at(static_cast<std::size_t>(level)).id;
    return made;
}

/// Levels 0, 1, ... with these times and errors.
inline BudgetEntry ladder(const std::string& name, const std::vector<std::pair<double, double>>& levels,
                          double step = 0.001, int level = 0) {
    std::vector<LevelOption> options;
    for (std::size_t i = 0; i < levels.size(); ++i)
        options.push_back({static_cast<int>(i), "level_" + std::to_string(i), levels[i].first,
                           levels[i].second, i + 1 < levels.size() ? step : 0});
    return entry(name, std::move(options), level);
}

/// Errors fall from level to level; times mostly rise, but now and then a level is dominated.
inline BudgetQuestion random_question(std::mt19937& random, int entries, int most_levels) {
    std::uniform_real_distribution<double> unit(0, 1);
    BudgetQuestion question;
    question.base_ms = unit(random);
    for (int i = 0; i < entries; ++i) {
        std::vector<std::pair<double, double>> levels;
        double ms = unit(random), error = 0.1 * unit(random);
        const int count = std::uniform_int_distribution<int>(1, most_levels)(random);
        for (int level = 0; level < count; ++level) {
            levels.emplace_back(ms, error);
            ms = std::max(0.0, ms + 3 * unit(random) - 0.3);
            error *= 0.2 + 0.7 * unit(random);
        }
        question.entries.push_back(ladder("effect_" + std::to_string(i), levels));
    }
    return question;
}

/// Time and error of the best of all choices, each looked at; the cheapest or most exact when none fits.
struct Best {
    double ms = std::numeric_limits<double>::infinity(), error = ms;
    bool fits = false;
};
inline Best best_by_trying(const BudgetQuestion& question, const Budget& budget) {
    const bool by_time = budget.of == Budget::Of::ms;
    Best best;
    std::vector<std::size_t> picks(question.entries.size(), 0);
    while (true) {
        double ms = question.base_ms, squares = 0;
        for (std::size_t i = 0; i < picks.size(); ++i) {
            if (question.entries[i].options.empty()) continue;
            const LevelOption& option = question.entries[i].options[picks[i]];
            ms += option.ms;
            squares += option.error * option.error;
        }
        const double error = std::sqrt(squares);
        const double kept = by_time ? ms : error, wanted = by_time ? error : ms;
        const double best_kept = by_time ? best.ms : best.error, best_wanted = by_time ? best.error : best.ms;
        const bool fits = kept <= budget.limit;
        if (fits ? !best.fits || wanted < best_wanted : !best.fits && kept < best_kept)
            best = {ms, error, fits};
        std::size_t i = 0;
        while (i < picks.size() && picks[i] + 1 >= question.entries[i].options.size())
            picks[i++] = 0;
        if (i == picks.size()) return best;
        ++picks[i];
    }
}

} // namespace budget_fixture
