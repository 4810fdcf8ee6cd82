// Asking for a budget: which level each effect of a chain gets, by what levels cost and how far they are from the
// truth. Pure functions, and a keeper that corrects the choice while the chain runs. No OpenGL.
#pragma once

#include <postfx/chain.hpp>
#include <postfx/curves.hpp>
#include <postfx/plan.hpp>

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

/// A level that may be chosen.
struct LevelOption {
    int level = 0; ///< index into the effect's levels; of an effect without levels 0
    std::string id;
    double ms = 0, error = 0;
    double step_to_next = 0; ///< LDR-FLIP, mean, to the next option's picture
    bool operator==(const LevelOption&) const = default;
};

/// One entry of the chain, as a budget sees it.
struct BudgetEntry {
    enum class Role {
        free,    ///< its level is chosen
        pinned,  ///< its level stays, and what it costs is known
        skipped, ///< costs nothing
        unknown, ///< no curve: its level stays, and what it costs is known to nobody
    };
    std::string name, effect;
    Role role = Role::free;
    std::string reason; ///< skipped or unknown: why
    int level = 0;      ///< that it has
    std::string level_id;
    std::vector<LevelOption>
        options; ///< as on the curve: of decreasing error there; of a pinned one its level alone
    bool operator==(const BudgetEntry&) const = default;
};
std::string_view role_name(BudgetEntry::Role role);

/// What a budget is to be met with: a chain, planned for a picture, and what its levels cost there.
struct BudgetQuestion {
    double base_ms = 0; ///< of the chain without effects
    std::vector<BudgetEntry> entries;
    bool operator==(const BudgetQuestion&) const = default;

    /// With the levels that entries have; nothing for those that cost nothing or have no curve.
    double ms() const;
    double error() const;
};

/// `plan`: of the chain; tells the picture's size and what is skipped. Levels that are on no curve are no options.
BudgetQuestion budget_question(const Chain& chain, const Curves& curves, const Plan& plan);

/// What levels were seen to do in one picture of a scene: curves are means over other scenes.
struct LevelTrial {
    /// By the entry's name in the chain, of its first options, as many as were tried: the root mean square of the
    /// difference, at the chain's end, from the last of them, as a share of the picture's own. So the last is 0.
    std::map<std::string, std::vector<double>> distances;
};

/// How many of each entry's options a budget may have a use for, from the least exact one on; 0 where there is nothing
/// to choose.
std::vector<std::size_t> options_to_try(const BudgetQuestion& question, const Budget& budget);

/// The question with the errors that the trial's scene tells. The last level that was tried has as much of its curve's
/// error as the distance between the first and it has of what the curve says of that; errors of those before it are
/// its own and their distance from it, taken to be independent. What was not tried keeps its curve's errors.
BudgetQuestion in_scene(BudgetQuestion question, const LevelTrial& trial);

/// A level for every entry of the chain.
struct Choice {
    std::vector<int> levels;
    double ms = 0;    ///< of the base and all entries whose cost is known, times the time scale
    double error = 0; ///< of all together: the root of the sum of squares
};
void apply(const Choice& choice, Chain& chain);

/// The choice next to the one that was made.
struct RunnerUp {
    Choice choice;
    Budget::Of lost_by = Budget::Of::ms; ///< too slow, or too far from the truth
};

struct BudgetAnswer {
    Choice choice;
    bool fits = true; ///< else the cheapest, or the most exact
    std::optional<RunnerUp> runner_up;
};

/// Errors that differ by less than this factor are the same: no curve is known any better.
inline constexpr double same_error = 1.01;

class ParetoFront;

/// Answers budgets for one question, each in microseconds: all choices that no other one dominates are found once.
class LevelChooser {
public:
    explicit LevelChooser(BudgetQuestion question);
    ~LevelChooser();
    LevelChooser(LevelChooser&&) noexcept;
    LevelChooser& operator=(LevelChooser&&) noexcept;

    /// The least error within a time, or the least time within an error. For a time, errors up to same_error times the
    /// least are as good, and of them the quickest choice is taken. Of choices that are equal in both, entries from the
    /// last on have the less exact level. `time_scale`: how much slower than its curves the chain runs.
    BudgetAnswer best(const Budget& budget, double time_scale = 1) const;

    const BudgetQuestion& question() const { return question_; }
    /// 0: the answers are exact. Chains with very many choices are answered with an error of at most this share above
    /// the least.
    double loss() const;

private:
    Choice choice_at(std::size_t point, double time_scale) const;

    BudgetQuestion question_;
    std::unique_ptr<ParetoFront> front_;
};

/// {"budget": {"ms" or "error"}, "fits", "predicted_ms", "predicted_error", "base_ms", "effects": [{"name", "id",
/// "level", "role", "reason", "ms", "error"}], "runner_up": {"ms", "error", "lost_by", "levels": {name: level}} or null};
/// what is not known is null.
std::string budget_json(const Budget& budget, const BudgetQuestion& question, const BudgetAnswer& answer);
/// The same for people: a table, the total against the budget, the runner-up.
std::string budget_text(const Budget& budget, const BudgetQuestion& question, const BudgetAnswer& answer);

/// The largest difference of two pictures, LDR-FLIP averaged over pixels, that a change at run time makes at once.
/// A just noticeable difference, 2.3 in CIELAB (Mahy et al. 1994), is 0.10 in FLIP (2.3^0.7 / (0.4 * 203^0.7) * 0.95,
/// Andersson et al. 2020, eqs. 8 and 9): so at most a tenth of the picture may change by as much as can be seen.
inline constexpr double visible_step = 0.01;

/// A change that would be seen at once is faded in over so many frames at most: half a second at 60 per second.
inline constexpr int longest_fade = 30;

/// In how many equal steps a picture has to turn into another one that differs by `step` (LDR-FLIP, mean), for no step
/// to be above visible_step. FLIP grows with the 0.7th power of small differences of colour and with the root of those
/// of edges (Andersson et al. 2020, eqs. 6 and 7); the root is reckoned with, so that it takes the square of how many
/// visible_steps it is.
int fade_frames(double step);

/// By which a running chain's levels follow its times, as shares of the budget. Over `tolerated` levels go down, to what
/// is predicted to take `aim`; up only to what takes `headroom`, and only if the error falls to `noticeably_better` of
/// what it is. Far enough apart that the median's noise does not cross both.
struct KeepingRule {
    double tolerated = 1.05, aim = 0.95, headroom = 0.9, noticeably_better = 0.95;
};
inline constexpr KeepingRule keeping_rule;

/// Levels that are to change.
struct LevelChange {
    Choice choice;
    int frames = 1; ///< over which the picture is to fade into that of the new levels; 1: at once
};

/// Keeps a running chain within its time: measured times correct what the curves predict, and levels change when that
/// is called for; at most once a second, by no more than visible_step from frame to frame, and up only when it will
/// last. A budget of error is kept by the first choice already.
class BudgetKeeper {
public:
    explicit BudgetKeeper(Budget budget) : budget_(budget) {}

    /// What runs from now on, with the levels that it has. Costs next to nothing if that is what ran before.
    void follow(const BudgetQuestion& question);
    /// A frame was drawn: when (seconds, of any start), and what the chain took. Gives the levels from the next frame
    /// on, when they are to change; they are taken to be applied.
    std::optional<LevelChange> frame(double seconds, double ms);

    const Budget& budget() const { return budget_; }
    double correction() const { return correction_; } ///< measured time as a multiple of the predicted
    int changes() const { return changes_; }
    /// Why the chain is over its budget and stays so; "" while it is not.
    const std::string& kept_over() const { return kept_over_; }
    /// What it does, for people, in a line or two.
    std::string text() const;

private:
    struct Sample {
        double seconds, value;
    };
    bool take(double seconds, double ms);
    std::optional<LevelChange> lower(double seconds);
    std::optional<LevelChange> raise(double seconds);
    LevelChange towards(const Choice& target, double time_scale) const;
    std::optional<LevelChange> change(double seconds, LevelChange change);
    const LevelChooser& reachable();

    Budget budget_;
    BudgetQuestion question_;
    std::optional<LevelChooser> reachable_; ///< by changes that are not seen
    std::optional<LevelChooser> all_;       ///< by any
    std::deque<Sample> ratios_, corrections_;
    double correction_ = 1;
    std::optional<double> last_change_, last_raise_;
    double calm_seconds_ = least_calm_seconds; ///< that a raise waits for
    int frames_to_ignore_ = settling_frames, changes_ = 0;
    std::string kept_over_;

    static constexpr double least_calm_seconds = 2;
    /// After a change: programs are compiled, and a GPU's times are read some frames late.
    static constexpr int settling_frames = 5;
};

} // namespace postfx
