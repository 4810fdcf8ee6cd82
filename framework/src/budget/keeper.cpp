#include <postfx/budget.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace postfx {
namespace {

constexpr double seconds_between_changes = 1;
/// Frames are judged by their median over so long, and at least so many: a single slow frame says nothing.
constexpr double window_seconds = 0.7;
constexpr std::size_t window_least = 5;
/// Being over the budget counts when the median was so for this long.
constexpr double insistent_seconds = 0.3;
/// A raise that had to be taken back so soon was a mistake: the next waits twice as long, at most so long.
constexpr double relapse_seconds = 10, most_calm_seconds = 64;

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Index into its options of the level that the entry has; nothing when it is none of them.
std::optional<std::size_t> option_index(const BudgetEntry& entry, int level) {
    for (std::size_t i = 0; i < entry.options.size(); ++i) {
        if (entry.options[i].level == level) return i;
    }
    return std::nullopt;
}

/// The most that one change may differ by.
bool can_be_faded(double step) {
    return fade_frames(step) <= longest_fade;
}

/// With only those options that are reached from the present level by changes that are not seen. Levels that were never
/// chosen from a curve stay.
BudgetQuestion reachable_question(BudgetQuestion question) {
    for (BudgetEntry& entry : question.entries) {
        const auto present = option_index(entry, entry.level);
        if (!present) {
            entry.options.clear();
            continue;
        }
        std::size_t first = *present, end = *present + 1;
        while (first > 0 && can_be_faded(entry.options[first - 1].step_to_next))
            --first;
        while (end < entry.options.size() && can_be_faded(entry.options[end - 1].step_to_next))
            ++end;
        entry.options.assign(entry.options.begin() + static_cast<std::ptrdiff_t>(first),
                             entry.options.begin() + static_cast<std::ptrdiff_t>(end));
    }
    return question;
}

/// One entry, one level nearer to a target.
struct Move {
    std::size_t entry;
    int level;
    double ms, squared_error, step; ///< what it adds, and what is seen of it
    double saved_per_step() const { return -ms / std::max(step, 1e-6); }
    double gained_per_step() const { return -squared_error / std::max(step, 1e-6); }
};

std::vector<Move> moves_towards(const BudgetQuestion& question, const Choice& target) {
    std::vector<Move> moves;
    for (std::size_t i = 0; i < question.entries.size(); ++i) {
        const BudgetEntry& entry = question.entries[i];
        const auto from = option_index(entry, entry.level), to = option_index(entry, target.levels[i]);
        if (!from || !to || *from == *to) continue;
        const std::size_t next = *to > *from ? *from + 1 : *from - 1;
        const LevelOption &a = entry.options[*from], &b = entry.options[next];
        moves.push_back({i, b.level, b.ms - a.ms, b.error * b.error - a.error * a.error,
                         entry.options[std::min(*from, next)].step_to_next});
    }
    return moves;
}

Choice levels_of(const BudgetQuestion& question, double time_scale) {
    Choice choice;
    for (const BudgetEntry& entry : question.entries)
        choice.levels.push_back(entry.level);
    choice.ms = time_scale * question.ms();
    choice.error = question.error();
    return choice;
}

} // namespace

void BudgetKeeper::follow(const BudgetQuestion& question) {
    if (question == question_) return;
    question_ = question;
    reachable_.reset();
    all_.reset();
}

const LevelChooser& BudgetKeeper::reachable() {
    if (!reachable_) reachable_.emplace(reachable_question(question_));
    return *reachable_;
}

int fade_frames(double step) {
    if (!(step > visible_step)) return 1;
    const double ratio = step / visible_step;
    return static_cast<int>(std::min(std::ceil(ratio * ratio), 1e6));
}

std::optional<LevelChange> BudgetKeeper::frame(double seconds, double ms) {
    if (budget_.of != Budget::Of::ms || !take(seconds, ms)) return std::nullopt;
    const double since_change = last_change_ ? seconds - *last_change_ : calm_seconds_;
    if (since_change < seconds_between_changes) return std::nullopt;
    // As quick as it was at any time of late: a burst is no reason.
    double quickest = correction_;
    for (const Sample& sample : corrections_) {
        if (seconds - sample.seconds <= insistent_seconds) quickest = std::min(quickest, sample.value);
    }
    if (quickest * question_.ms() > keeping_rule.tolerated * budget_.limit) return lower(seconds);
    kept_over_.clear();
    const bool calm = since_change >= calm_seconds_ && !corrections_.empty()
                      && seconds - corrections_.front().seconds >= 0.9 * least_calm_seconds;
    return calm ? raise(seconds) : std::nullopt;
}

/// Take the frame into account; false while there is too little to judge by.
bool BudgetKeeper::take(double seconds, double ms) {
    const double predicted = question_.ms();
    if (!(ms > 0) || !std::isfinite(ms) || !(predicted > 0)) return false;
    if (frames_to_ignore_ > 0) {
        --frames_to_ignore_;
        return false;
    }
    ratios_.push_back({seconds, ms / predicted});
    while (ratios_.size() > window_least && seconds - ratios_.front().seconds > window_seconds)
        ratios_.pop_front();
    if (ratios_.size() < window_least) return false;
    std::vector<double> values;
    for (const Sample& sample : ratios_)
        values.push_back(sample.value);
    correction_ = median_of(std::move(values));
    corrections_.push_back({seconds, correction_});
    while (seconds - corrections_.front().seconds > least_calm_seconds)
        corrections_.pop_front();
    return true;
}

std::optional<LevelChange> BudgetKeeper::lower(double seconds) {
    // The older half of the window may be of before the load rose: one change is to be enough.
    std::vector<double> latest;
    for (const Sample& sample : ratios_) {
        if (seconds - sample.seconds <= insistent_seconds) latest.push_back(sample.value);
    }
    const bool enough = latest.size() >= window_least;
    const double slowdown = enough ? std::max(correction_, median_of(std::move(latest))) : correction_;
    const Budget wanted = {Budget::Of::ms, keeping_rule.aim * budget_.limit};
    const BudgetAnswer answer = reachable().best(wanted, slowdown);
    if (last_raise_) {
        const bool relapse = seconds - *last_raise_ < relapse_seconds;
        calm_seconds_ = relapse ? std::min(2 * calm_seconds_, most_calm_seconds) : least_calm_seconds;
        last_raise_.reset();
    }
    std::optional<LevelChange> lowered = change(seconds, towards(answer.choice, slowdown));
    kept_over_.clear();
    if (!answer.fits && !lowered) {
        if (!all_) all_.emplace(question_);
        const bool seen = all_->best(wanted, slowdown).choice.ms < answer.choice.ms;
        kept_over_ = seen ? "what is cheaper would be seen to change" : "nothing is cheaper";
    }
    return lowered;
}

std::optional<LevelChange> BudgetKeeper::raise(double seconds) {
    // As slow as it was at any time of the calm: a lull is no reason.
    double slowest = 0;
    for (const Sample& sample : corrections_)
        slowest = std::max(slowest, sample.value);
    const BudgetAnswer answer =
        reachable().best({Budget::Of::ms, keeping_rule.headroom * budget_.limit}, slowest);
    if (!answer.fits || answer.choice.error > keeping_rule.noticeably_better * question_.error())
        return std::nullopt;
    std::optional<LevelChange> raised = change(seconds, towards(answer.choice, slowest));
    if (raised) last_raise_ = seconds;
    return raised;
}

/// The target, or as far towards it as is not seen in one change. What saves time goes first, so that what takes more
/// finds room.
LevelChange BudgetKeeper::towards(const Choice& target, double time_scale) const {
    BudgetQuestion reached = question_;
    double seen = 0;
    while (true) {
        std::vector<Move> moves = moves_towards(reached, target);
        std::erase_if(moves, [&](const Move& move) {
            const bool in_time = time_scale * (reached.ms() + move.ms) <= budget_.limit;
            return !can_be_faded(seen + move.step) || (move.ms > 0 && !in_time);
        });
        if (moves.empty()) return {levels_of(reached, time_scale), fade_frames(seen)};
        const Move& best = *std::max_element(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
            return std::pair(a.saved_per_step() > 0 ? a.saved_per_step() : 0, a.gained_per_step())
                   < std::pair(b.saved_per_step() > 0 ? b.saved_per_step() : 0, b.gained_per_step());
        });
        reached.entries[best.entry].level = best.level;
        seen += best.step;
    }
}

std::optional<LevelChange> BudgetKeeper::change(double seconds, LevelChange change) {
    bool same = true;
    for (std::size_t i = 0; i < change.choice.levels.size(); ++i) {
        BudgetEntry& entry = question_.entries[i];
        if (entry.level == change.choice.levels[i]) continue;
        same = false;
        entry.level = change.choice.levels[i];
        entry.level_id = entry.options[*option_index(entry, entry.level)].id;
    }
    if (same) return std::nullopt;
    // What can be reached stays the same: a change that is not seen leads back as well.
    last_change_ = seconds;
    frames_to_ignore_ = settling_frames;
    ratios_.clear();
    corrections_.clear();
    ++changes_;
    return change;
}

std::string BudgetKeeper::text() const {
    if (budget_.of != Budget::Of::ms)
        return "  a budget of error is kept by the levels chosen at the start\n";
    std::string text =
        fmt::format("  measured {:.3g} ms: {:.2f} of what the curves predict; {} change{} so far\n",
                    correction_ * question_.ms(), correction_, changes_, changes_ == 1 ? "" : "s");
    if (!kept_over_.empty()) text += fmt::format("  over the budget: {}\n", kept_over_);
    return text;
}

} // namespace postfx
