#include <postfx/budget.hpp>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

bool is_free(const BudgetEntry& entry) {
    return entry.role == BudgetEntry::Role::free && entry.options.size() > 1;
}

double least_ms(const BudgetEntry& entry) {
    const auto least =
        std::min_element(entry.options.begin(), entry.options.end(),
                         [](const LevelOption& a, const LevelOption& b) { return a.ms < b.ms; });
    return least == entry.options.end() ? 0 : least->ms;
}

/// Up to the last option that fits if all other entries take as little time as they can.
std::vector<std::size_t> affordable(const BudgetQuestion& question, double limit_ms) {
    double rest = limit_ms - question.base_ms;
    for (const BudgetEntry& entry : question.entries)
        rest -= least_ms(entry);
    std::vector<std::size_t> counts;
    for (const BudgetEntry& entry : question.entries) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < entry.options.size() && is_free(entry); ++i) {
            if (entry.options[i].ms - least_ms(entry) <= rest) count = i + 1;
        }
        counts.push_back(count);
    }
    return counts;
}

/// Up to the one behind the option that curves alone choose.
std::vector<std::size_t> near_by(const BudgetQuestion& question, const Budget& budget) {
    const Choice choice = LevelChooser(question).best(budget).choice;
    std::vector<std::size_t> counts;
    for (std::size_t e = 0; e < question.entries.size(); ++e) {
        const BudgetEntry& entry = question.entries[e];
        std::size_t count = 0;
        for (std::size_t i = 0; i < entry.options.size() && is_free(entry); ++i) {
            if (entry.options[i].level == choice.levels[e]) count = std::min(i + 2, entry.options.size());
        }
        counts.push_back(count);
    }
    return counts;
}

/// What lies between two levels whose errors are independent of each other's.
double distance_of(double less_exact, double more_exact) {
    return std::sqrt(std::max(0.0, less_exact * less_exact - more_exact * more_exact));
}

void rescale(std::vector<LevelOption>& options, const std::vector<double>& distances) {
    if (distances.size() < 2 || distances.size() > options.size()) return;
    const std::size_t last = distances.size() - 1;
    const double expected = distance_of(options.front().error, options[last].error);
    if (!(expected > 0)) return;
    const double scale = distances.front() / expected;
    for (LevelOption& option : options)
        option.error *= scale;
    for (std::size_t i = 0; i < last; ++i)
        options[i].error = std::hypot(distances[i], options[last].error);
}

} // namespace

std::vector<std::size_t> options_to_try(const BudgetQuestion& question, const Budget& budget) {
    return budget.of == Budget::Of::ms ? affordable(question, budget.limit) : near_by(question, budget);
}

BudgetQuestion in_scene(BudgetQuestion question, const LevelTrial& trial) {
    for (BudgetEntry& entry : question.entries) {
        const auto tried = trial.distances.find(entry.name);
        if (is_free(entry) && tried != trial.distances.end()) rescale(entry.options, tried->second);
    }
    return question;
}

} // namespace postfx
