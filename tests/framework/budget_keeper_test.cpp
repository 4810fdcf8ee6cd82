// Budgets while a chain runs: loads that change are replayed, and it is checked what the keeper does about them.
#include <catch2/catch.hpp>

#include "budget_fixture.hpp"

#include <functional>

using namespace budget_fixture;
using postfx::BudgetKeeper;

namespace {

constexpr double seconds_per_frame = 1.0 / 60;

/// The load at a time: how many times longer than its curves say the chain takes.
using Load = std::function<double(double seconds)>;

/// What is measured of a frame beside its load: noise of some share, and now and then a spike.
struct Disturbance {
    double noise = 0, spike_chance = 0;
};

struct Change {
    double seconds;
    Choice choice;
    int frames;
};

/// A run: the chain's true time (without noise) at every frame, and what was changed.
struct Replay {
    std::vector<double> seconds, ms;
    std::vector<Change> changes;
    BudgetQuestion question; ///< with the levels at the end

    double longest_ms(double from, double to) const {
        double longest = 0;
        for (std::size_t i = 0; i < ms.size(); ++i) {
            if (seconds[i] >= from && seconds[i] < to) longest = std::max(longest, ms[i]);
        }
        return longest;
    }
    std::size_t changes_in(double from, double to) const {
        return static_cast<std::size_t>(std::count_if(changes.begin(), changes.end(), [&](const Change& c) {
            return c.seconds >= from && c.seconds < to;
        }));
    }
};

/// FLIP from one level of an entry to another.
double step_between(const BudgetEntry& entry, int from, int to) {
    double step = 0;
    for (int i = std::min(from, to); i < std::max(from, to); ++i)
        step += entry.options[static_cast<std::size_t>(i)].step_to_next;
    return step;
}

/// The most that one change may differ by: as many visible steps as the longest fade hides.
double largest_change() {
    double step = postfx::visible_step;
    while (postfx::fade_frames(1.001 * step) <= postfx::longest_fade)
        step *= 1.001;
    return step;
}

/// Runs the keeper through a load and checks what holds always: a second between changes, none that is seen.
Replay replay(BudgetKeeper& keeper, BudgetQuestion question, double seconds, const Load& load,
              Disturbance disturbance = {}) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    Replay run;
    for (int frame = 0; frame * seconds_per_frame < seconds; ++frame) {
        const double now = frame * seconds_per_frame;
        const double ms = load(now) * question.ms();
        run.seconds.push_back(now);
        run.ms.push_back(ms);
        double measured = ms * (1 + disturbance.noise * (2 * unit(random) - 1));
        if (unit(random) < disturbance.spike_chance) measured *= 5;
        keeper.follow(question);
        const auto change = keeper.frame(now, measured);
        if (!change) continue;
        double seen = 0;
        for (std::size_t i = 0; i < question.entries.size(); ++i) {
            BudgetEntry& entry = question.entries[i];
            if (entry.options.empty()) continue;
            seen += step_between(entry, entry.level, change->choice.levels[i]);
            entry.level = change->choice.levels[i];
            entry.level_id = entry.options[static_cast<std::size_t>(entry.level)].id;
        }
        CHECK(seen > 0);
        CHECK(seen <= largest_change() * 1.001); // found in steps of so much
        CHECK(change->frames <= postfx::longest_fade);
        // Steps are added up in another order.
        CHECK(change->frames >= postfx::fade_frames(seen * (1 - 1e-12)));
        if (!run.changes.empty()) CHECK(now - run.changes.back().seconds >= 1);
        run.changes.push_back({now, change->choice, change->frames});
    }
    run.question = question;
    return run;
}

/// Three effects of five levels each; one level up costs about 1.5 times as much and halves the error.
BudgetQuestion three_effects(double step = 0.0002) {
    BudgetQuestion question;
    question.base_ms = 0.5;
    question.entries = {
        ladder("a", {{0.2, 0.08}, {0.3, 0.04}, {0.45, 0.02}, {0.7, 0.01}, {1.1, 0.004}}, step),
        ladder("b", {{0.5, 0.2}, {0.8, 0.1}, {1.3, 0.05}, {2.0, 0.02}, {3.2, 0.01}}, step),
        ladder("c", {{0.3, 0.1}, {0.5, 0.06}, {0.8, 0.03}, {1.3, 0.015}, {2.2, 0.006}}, step),
    };
    return question;
}

/// With the levels that the curves alone choose.
BudgetQuestion chosen(BudgetQuestion question, const Budget& budget) {
    const Choice choice = postfx::LevelChooser(question).best(budget).choice;
    for (std::size_t i = 0; i < question.entries.size(); ++i) {
        BudgetEntry& entry = question.entries[i];
        entry.level = choice.levels[i];
        entry.level_id = entry.options[static_cast<std::size_t>(entry.level)].id;
    }
    return question;
}

/// A slow phase between two fast ones.
double slow_phase(double seconds) {
    return seconds >= 10 && seconds < 20 ? 1.8 : 1.0;
}

} // namespace

TEST_CASE("the budget holds a second after each change of load") {
    const Budget budget = within_ms(5);
    const Disturbance disturbance = GENERATE(Disturbance{}, Disturbance{0.2, 0}, Disturbance{0.2, 0.1});
    // At once, and over several frames.
    const double step = GENERATE(0.0002, 1.1 * postfx::visible_step);
    CAPTURE(disturbance.noise, disturbance.spike_chance, step);
    BudgetKeeper keeper(budget);
    const Replay run = replay(keeper, chosen(three_effects(step), budget), 30, slow_phase, disturbance);
    CHECK(run.longest_ms(10, 11) > 1.1 * budget.limit); // there was something to do
    CHECK(run.longest_ms(1, 10) <= 1.1 * budget.limit);
    CHECK(run.longest_ms(11, 20) <= 1.1 * budget.limit);
    CHECK(run.longest_ms(21, 30) <= 1.1 * budget.limit);
    CHECK(run.changes_in(0, 10) <= 2);
    CHECK(run.changes_in(10, 20) >= 1);
    CHECK(run.changes_in(10, 20) <= 3);
    CHECK(run.changes_in(20, 30) >= 1); // what the slow phase took is given back
    CHECK(run.changes_in(20, 30) <= 4);
    for (std::size_t i = 1; i < run.changes.size(); ++i) { // and no way back within a phase
        if (run.changes[i - 1].seconds >= 20)
            CHECK(run.changes[i].choice.error < run.changes[i - 1].choice.error);
    }
    CHECK(run.question.error() <= 1.7 * chosen(three_effects(), within_ms(0.9 * 5)).error());
}

TEST_CASE("curves of a faster device are corrected") {
    const Budget budget = within_ms(5);
    const double factor = GENERATE(0.4, 1.7);
    BudgetKeeper keeper(budget);
    const BudgetQuestion start = chosen(three_effects(), budget);
    const Replay run = replay(keeper, start, 12, [&](double) { return factor; }, {0.1, 0});
    CHECK(run.longest_ms(1, 12) <= 1.1 * budget.limit);
    CHECK(keeper.correction() == Approx(factor).epsilon(0.05)); // the median of noise of a tenth
    CHECK((run.question.error() < start.error()) == (factor < 1));
    CHECK(run.changes_in(6, 12) == 0);
}

TEST_CASE("noise around the budget makes no flicker") {
    const Budget budget = within_ms(5);
    // Loads at which a level fits just so, or just not, for two minutes.
    const double load = GENERATE(0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2);
    CAPTURE(load);
    BudgetKeeper keeper(budget);
    const Replay run =
        replay(keeper, chosen(three_effects(), budget), 120, [&](double) { return load; }, {0.2, 0.05});
    for (const Change& change : run.changes)
        UNSCOPED_INFO(change.seconds << " s: to " << change.choice.ms << " ms");
    CHECK(run.changes.size() <= 4);
    CHECK(run.changes_in(60, 120) <= 2); // rarely, noise looks like a load for as long as the keeper waits
    CHECK(run.longest_ms(2, 120) <= 1.1 * budget.limit);
}

TEST_CASE("a choice that takes longer than predicted is not tried again and again") {
    // The curves know nothing of it, but level 1 takes thrice as long as they say.
    const Budget budget = within_ms(5);
    BudgetQuestion question;
    question.entries = {ladder("a", {{2, 0.1}, {4, 0.05}})};
    BudgetKeeper keeper(budget);
    std::size_t changes = 0;
    for (int frame = 0; frame < 60 * 300; ++frame) {
        keeper.follow(question);
        const auto change = keeper.frame(frame * seconds_per_frame, question.entries[0].level == 1 ? 12 : 2);
        if (!change) continue;
        ++changes;
        question.entries[0].level = change->choice.levels[0];
        question.entries[0].level_id = change->choice.levels[0] == 1 ? "level_1" : "level_0";
    }
    CHECK(changes >= 2);
    CHECK(changes <= 16); // waits double up to a minute: 2, 4, ... 64, 64, 64 seconds
    CHECK(question.entries[0].level == 0);
}

TEST_CASE("changes that would be seen are made in several steps") {
    const Budget budget = within_ms(5);
    // Every level is 0.4 of what can be faded over: two at once.
    const BudgetQuestion start = chosen(three_effects(0.4 * largest_change()), budget);
    BudgetKeeper keeper(budget);
    const Replay run = replay(keeper, start, 20, [](double seconds) { return seconds < 5 ? 1.0 : 3.0; });
    CHECK(run.changes_in(5, 15) >= 3);
    // Whatever is left is base and cheapest levels: nothing more can be done.
    CHECK(run.longest_ms(14, 20) <= std::max(1.1 * budget.limit, 3.0 * 1.5));
    CHECK(run.changes_in(14, 20) == 0);
}

TEST_CASE("as many frames as keep each step of a fade from being seen") {
    using postfx::fade_frames, postfx::visible_step;
    CHECK(fade_frames(0) == 1);
    CHECK(fade_frames(visible_step) == 1);
    CHECK(fade_frames(1.01 * visible_step) == 2);
    for (double step = visible_step; step < 1; step *= 1.07) {
        CAPTURE(step);
        const double frames = fade_frames(step);
        CHECK(step / std::sqrt(frames) <= visible_step * (1 + 1e-12)); // a root and a power of it
        if (frames > 1) CHECK(step / std::sqrt(frames - 1) > visible_step * (1 - 1e-12));
    }
    CHECK(fade_frames(std::numeric_limits<double>::infinity()) > postfx::longest_fade);
}

TEST_CASE("a change is left out when any step would be seen") {
    const Budget budget = within_ms(5);
    BudgetQuestion question;
    question.entries = {ladder("a", {{1, 0.1}, {4, 0.05}}, 1.1 * largest_change(), 1)};
    BudgetKeeper keeper(budget);
    const Replay run = replay(keeper, question, 5, [](double) { return 2.0; });
    CHECK(run.changes.empty());
    CHECK(keeper.kept_over() == "what is cheaper would be seen to change");
    CHECK(keeper.text().find("over the budget: what is cheaper would be seen") != std::string::npos);

    question.entries = {ladder("a", {{1, 0.1}, {4, 0.05}}, 0.001, 0)};
    BudgetKeeper lowest(within_ms(0.5));
    CHECK(replay(lowest, question, 5, [](double) { return 1.0; }).changes.empty());
    CHECK(lowest.kept_over() == "nothing is cheaper");
}

TEST_CASE("a budget of error changes nothing while it runs") {
    const Budget budget = within_error(0.05);
    BudgetKeeper keeper(budget);
    CHECK(replay(keeper, chosen(three_effects(), budget), 30, slow_phase, {0.3, 0.1}).changes.empty());
}

TEST_CASE("pinned and skipped effects are left alone, and times that are none are ignored") {
    const Budget budget = within_ms(2);
    BudgetQuestion question = three_effects();
    question.entries[0].role = BudgetEntry::Role::pinned;
    question.entries[0].level = 3;
    question.entries[0].options = {question.entries[0].options[3]};
    question.entries[1].role = BudgetEntry::Role::skipped;
    question.entries[1].level = 4;
    question.entries[1].options.clear();
    question.entries[2].level = 4;
    BudgetKeeper keeper(budget);
    for (const double ms :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        keeper.follow(question);
        for (int i = 0; i < 600; ++i)
            CHECK_FALSE(keeper.frame(i * seconds_per_frame, ms));
    }
    std::optional<postfx::LevelChange> change;
    for (int i = 600; i < 1200 && !change; ++i)
        change = keeper.frame(i * seconds_per_frame, 3.4);
    REQUIRE(change);
    CHECK(change->choice.levels[0] == 3);
    CHECK(change->choice.levels[1] == 4);
    CHECK(change->choice.levels[2] < 4);
}
