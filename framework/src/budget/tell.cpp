#include <postfx/budget.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace postfx {
namespace {

using Json = nlohmann::ordered_json;

/// One entry of the chain with the level that was chosen for it.
struct Row {
    const BudgetEntry* entry;
    const LevelOption* option; ///< null where time and error are not known, or nothing
    std::string level;
};

std::vector<Row> rows_of(const BudgetQuestion& question, const Choice& choice) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < question.entries.size(); ++i) {
        const BudgetEntry& entry = question.entries[i];
        const auto found =
            std::find_if(entry.options.begin(), entry.options.end(),
                         [&](const LevelOption& option) { return option.level == choice.levels.at(i); });
        const bool known = found != entry.options.end();
        rows.push_back({&entry, known ? &*found : nullptr, known ? found->id : entry.level_id});
    }
    return rows;
}

std::string amount_text(Budget::Of of, double amount) {
    return of == Budget::Of::ms ? fmt::format("{:.3g} ms", amount) : fmt::format("error {:.3g}", amount);
}

/// How far the best is from fitting.
std::string verdict(const Budget& budget, const BudgetAnswer& answer) {
    if (answer.fits) return "fits";
    const bool by_time = budget.of == Budget::Of::ms;
    const double reached = by_time ? answer.choice.ms : answer.choice.error;
    return fmt::format("{:.0f} % over, and nothing is {}", 100 * (reached / budget.limit - 1),
                       by_time ? "cheaper" : "more exact");
}

/// What another choice does otherwise: "haze high".
std::string differences_text(const BudgetQuestion& question, const Choice& from, const Choice& to) {
    const std::vector<Row> before = rows_of(question, from), after = rows_of(question, to);
    std::string text;
    for (std::size_t i = 0; i < after.size(); ++i) {
        if (before[i].level == after[i].level) continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", after[i].entry->name, after[i].level);
    }
    return text;
}

std::string row_text(const Row& row, std::size_t name_width) {
    using Role = BudgetEntry::Role;
    const std::string level = row.level.empty() ? "-" : row.level;
    std::string text = fmt::format("  {:<{}}  {:<10}", row.entry->name, name_width, level);
    if (row.option) {
        text += fmt::format("  {:8.3f} ms  error {:<9.3g}", row.option->ms, row.option->error);
    } else {
        text += fmt::format("  {:>8} ms  error {:<9}", row.entry->role == Role::skipped ? "0" : "?",
                            row.entry->role == Role::skipped ? "0" : "?");
    }
    if (row.entry->role == Role::pinned) text += "  pinned";
    if (row.entry->role == Role::skipped) text += "  skipped, " + row.entry->reason;
    if (row.entry->role == Role::unknown) text += "  keeps its level: " + row.entry->reason;
    while (text.ends_with(' '))
        text.pop_back();
    return text + "\n";
}

} // namespace

std::string budget_json(const Budget& budget, const BudgetQuestion& question, const BudgetAnswer& answer) {
    Json effects = Json::array();
    for (const Row& row : rows_of(question, answer.choice)) {
        const bool nothing = row.entry->role == BudgetEntry::Role::skipped;
        const auto known = [&](double value) {
            return row.option ? Json(value) : nothing ? Json(0) : Json();
        };
        effects.push_back({{"name", row.entry->name},
                           {"id", row.entry->effect},
                           {"level", row.level.empty() ? Json() : Json(row.level)},
                           {"role", role_name(row.entry->role)},
                           {"reason", row.entry->reason},
                           {"ms", known(row.option ? row.option->ms : 0)},
                           {"error", known(row.option ? row.option->error : 0)}});
    }
    Json runner_up;
    if (answer.runner_up) {
        Json levels = Json::object();
        for (const Row& row : rows_of(question, answer.runner_up->choice)) {
            if (row.option && !row.level.empty()) levels[row.entry->name] = row.level;
        }
        runner_up = {{"ms", answer.runner_up->choice.ms},
                     {"error", answer.runner_up->choice.error},
                     {"lost_by", budget_word(answer.runner_up->lost_by)},
                     {"levels", std::move(levels)}};
    }
    const Json json = {{"budget", {{budget_word(budget.of), budget.limit}}},
                       {"fits", answer.fits},
                       {"predicted_ms", answer.choice.ms},
                       {"predicted_error", answer.choice.error},
                       {"base_ms", question.base_ms},
                       {"effects", std::move(effects)},
                       {"runner_up", std::move(runner_up)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string budget_text(const Budget& budget, const BudgetQuestion& question, const BudgetAnswer& answer) {
    const std::vector<Row> rows = rows_of(question, answer.choice);
    std::size_t name_width = 0;
    bool all_known = true;
    for (const Row& row : rows) {
        name_width = std::max(name_width, row.entry->name.size());
        all_known = all_known && row.entry->role != BudgetEntry::Role::unknown;
    }
    std::string text = fmt::format("budget: {}\n", amount_text(budget.of, budget.limit));
    for (const Row& row : rows)
        text += row_text(row, name_width);
    text += fmt::format("  predicted {:.3g} ms, {:.3g} of them without any effect; error {:.3g}; {}\n",
                        answer.choice.ms, question.base_ms, answer.choice.error, verdict(budget, answer));
    if (!all_known) text += "  effects without a curve are in neither sum\n";
    if (answer.runner_up) {
        const auto& [choice, lost_by] = *answer.runner_up;
        text += fmt::format("  runner-up: {:.3g} ms, error {:.3g} ({}): {}\n", choice.ms, choice.error,
                            differences_text(question, answer.choice, choice),
                            lost_by == Budget::Of::ms ? "takes longer" : "is less exact");
    }
    return text;
}

} // namespace postfx
