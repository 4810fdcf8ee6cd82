#include <postfx/budget.hpp>

#include "budget/front.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace postfx {
namespace {

/// Levels of the effect that have a curve. Steps to levels that the effect does not have are added up.
std::vector<LevelOption> options_of(const EffectInfo& effect, const std::vector<LevelCurve>& curves,
                                    double megapixels) {
    std::vector<LevelOption> options;
    for (const LevelCurve& curve : curves) {
        const auto level = std::find_if(effect.levels.begin(), effect.levels.end(),
                                        [&](const LevelInfo& info) { return info.id == curve.level; });
        const bool only = effect.levels.empty() && curve.level.empty();
        if (only || level != effect.levels.end()) {
            const int index = only ? 0 : static_cast<int>(level - effect.levels.begin());
            options.push_back(
                {index, curve.level, curve.time.at(megapixels), curve.error, curve.step_to_next});
        } else if (!options.empty()) {
            options.back().step_to_next += curve.step_to_next;
        }
    }
    return options;
}

BudgetEntry unknown(BudgetEntry entry, std::string reason) {
    entry.role = BudgetEntry::Role::unknown;
    entry.reason = std::move(reason);
    entry.options.clear();
    return entry;
}

BudgetEntry budget_entry(const ChainEntry& entry, const PlannedEffect& planned, const Curves& curves,
                         double megapixels) {
    using Role = BudgetEntry::Role;
    const EffectInfo& effect = *entry.effect;
    BudgetEntry result;
    result.name = entry.name;
    result.effect = effect.id;
    result.level = entry.level;
    if (!effect.levels.empty()) result.level_id = effect.levels.at(static_cast<std::size_t>(entry.level)).id;
    if (planned.status == EffectStatus::skipped) {
        result.role = Role::skipped;
        result.reason = planned.moment ? fmt::format("{}: {}", moment_word(*planned.moment), planned.reason)
                                       : planned.reason;
        return result;
    }
    const auto known = curves.effects.find(effect.id);
    if (known == curves.effects.end()) return unknown(std::move(result), "it has no curve");
    result.options = options_of(effect, known->second, megapixels);
    if (result.options.empty()) return unknown(std::move(result), "no level that it has is on its curve");
    if (!entry.pinned) return result;

    result.role = Role::pinned;
    const auto at = std::find_if(result.options.begin(), result.options.end(),
                                 [&](const LevelOption& option) { return option.level == entry.level; });
    if (at == result.options.end()) {
        std::string reason = fmt::format("pinned to {}, which is not on its curve", result.level_id);
        return unknown(std::move(result), std::move(reason));
    }
    const LevelOption pinned = *at;
    result.options = {pinned};
    return result;
}

const LevelOption* option_at(const BudgetEntry& entry, int level) {
    const auto found = std::find_if(entry.options.begin(), entry.options.end(),
                                    [&](const LevelOption& option) { return option.level == level; });
    return found == entry.options.end() ? nullptr : &*found;
}

double share_above(double value, double limit) {
    return value / limit - 1;
}

} // namespace

std::string_view role_name(BudgetEntry::Role role) {
    constexpr std::string_view names[] = {"free", "pinned", "skipped", "unknown"};
    return names[static_cast<std::size_t>(role)];
}

double BudgetQuestion::ms() const {
    double sum = base_ms;
    for (const BudgetEntry& entry : entries) {
        if (const LevelOption* option = option_at(entry, entry.level)) sum += option->ms;
    }
    return sum;
}

double BudgetQuestion::error() const {
    double squares = 0;
    for (const BudgetEntry& entry : entries) {
        if (const LevelOption* option = option_at(entry, entry.level))
            squares += option->error * option->error;
    }
    return std::sqrt(squares);
}

BudgetQuestion budget_question(const Chain& chain, const Curves& curves, const Plan& plan) {
    const double megapixels = 1e-6 * plan.width * plan.height;
    BudgetQuestion question;
    question.base_ms = curves.base.at(megapixels);
    for (std::size_t i = 0; i < chain.entries.size(); ++i)
        question.entries.push_back(budget_entry(chain.entries[i], plan.effects.at(i), curves, megapixels));
    return question;
}

void apply(const Choice& choice, Chain& chain) {
    for (std::size_t i = 0; i < chain.entries.size(); ++i)
        chain.entries[i].level = choice.levels.at(i);
}

LevelChooser::LevelChooser(BudgetQuestion question)
    : question_(std::move(question)), front_(std::make_unique<ParetoFront>()) {
    for (const BudgetEntry& entry : question_.entries) {
        std::vector<FrontPoint> options;
        for (const LevelOption& option : entry.options)
            options.push_back({option.ms, option.error * option.error});
        if (!options.empty()) front_->add(options);
    }
}

LevelChooser::~LevelChooser() = default;
LevelChooser::LevelChooser(LevelChooser&&) noexcept = default;
LevelChooser& LevelChooser::operator=(LevelChooser&&) noexcept = default;

double LevelChooser::loss() const {
    return std::sqrt(1 + front_->loss()) - 1;
}

Choice LevelChooser::choice_at(std::size_t point, double time_scale) const {
    const FrontPoint& sum = front_->points()[point];
    Choice choice;
    choice.ms = time_scale * (question_.base_ms + sum.ms);
    choice.error = std::sqrt(sum.squared_error);
    const std::vector<std::size_t> picks = front_->picks(point);
    std::size_t group = 0;
    for (const BudgetEntry& entry : question_.entries)
        choice.levels.push_back(entry.options.empty() ? entry.level : entry.options[picks[group++]].level);
    return choice;
}

BudgetAnswer LevelChooser::best(const Budget& budget, double time_scale) const {
    const std::vector<FrontPoint>& points = front_->points();
    const bool by_time = budget.of == Budget::Of::ms;
    const auto in_time = [&](const FrontPoint& point) {
        return time_scale * (question_.base_ms + point.ms) <= budget.limit;
    };
    // Quicker ones come first, more exact ones last.
    const auto first_within = [&](double error) {
        const auto too_far = [&](const FrontPoint& point) { return std::sqrt(point.squared_error) > error; };
        return static_cast<std::size_t>(std::partition_point(points.begin(), points.end(), too_far)
                                        - points.begin());
    };
    BudgetAnswer answer;
    std::size_t chosen = 0;
    if (by_time) {
        const auto edge = std::partition_point(points.begin(), points.end(), in_time);
        answer.fits = edge != points.begin();
        if (answer.fits) chosen = first_within(same_error * std::sqrt(std::prev(edge)->squared_error));
    } else {
        chosen = first_within(budget.limit);
        answer.fits = chosen < points.size();
        if (!answer.fits) chosen = points.size() - 1;
    }
    answer.choice = choice_at(chosen, time_scale);

    // Of its neighbours, the one that lost by less.
    std::optional<RunnerUp> cheaper, dearer;
    if (chosen > 0) cheaper = {choice_at(chosen - 1, time_scale), Budget::Of::error};
    if (chosen + 1 < points.size()) dearer = {choice_at(chosen + 1, time_scale), Budget::Of::ms};
    if (cheaper && dearer) {
        const double error_limit = by_time || !answer.fits ? answer.choice.error : budget.limit;
        const double time_limit = by_time && answer.fits ? budget.limit : answer.choice.ms;
        const bool dearer_is_nearer =
            share_above(dearer->choice.ms, time_limit) < share_above(cheaper->choice.error, error_limit);
        answer.runner_up = dearer_is_nearer ? dearer : cheaper;
    } else {
        answer.runner_up = cheaper ? cheaper : dearer;
    }
    return answer;
}

} // namespace postfx
