// What a trial of levels in a scene does to a question: laws of in_scene(), and that nothing is left untried that could
// be chosen.
#include <catch2/catch.hpp>

#include "budget_fixture.hpp"

using namespace budget_fixture;
using postfx::in_scene;
using postfx::LevelChooser;
using postfx::LevelTrial;
using postfx::options_to_try;

namespace {

constexpr double rounding = 1e-12; ///< of a few sums and roots

/// What the curves themselves say lies between each option and the last of `count`.
std::vector<double> expected_distances(const BudgetEntry& entry, std::size_t count) {
    const double last = entry.options[count - 1].error;
    std::vector<double> distances;
    for (std::size_t i = 0; i < count; ++i)
        distances.push_back(std::sqrt(entry.options[i].error * entry.options[i].error - last * last));
    return distances;
}

BudgetQuestion blur_and_haze() {
    BudgetQuestion question;
    question.base_ms = 1;
    question.entries = {ladder("blur", {{1, 0.1}, {2, 0.05}, {4, 0.01}}),
                        ladder("haze", {{1, 0.08}, {3, 0.02}, {9, 0.01}})};
    return question;
}

} // namespace

TEST_CASE(
    "a scene that does what the curves say changes nothing, and one of larger differences scales them") {
    std::mt19937 random(11);
    for (int round = 0; round < 100; ++round) {
        const BudgetQuestion question = random_question(random, 3, 5);
        const double scale = round % 2 ? 1 : std::uniform_real_distribution<double>(0, 3)(random);
        LevelTrial trial;
        for (const BudgetEntry& entry : question.entries) {
            const std::size_t count =
                std::uniform_int_distribution<std::size_t>(1, entry.options.size())(random);
            if (count < 2) continue;
            trial.distances[entry.name] = expected_distances(entry, count);
            for (double& distance : trial.distances[entry.name])
                distance *= scale;
        }
        const BudgetQuestion seen = in_scene(question, trial);
        CHECK(seen.base_ms == question.base_ms);
        for (std::size_t e = 0; e < seen.entries.size(); ++e) {
            const bool tried = trial.distances.contains(question.entries[e].name);
            for (std::size_t i = 0; i < seen.entries[e].options.size(); ++i) {
                CAPTURE(round, e, i);
                const LevelOption &before = question.entries[e].options[i],
                                  &after = seen.entries[e].options[i];
                CHECK(after.error == Approx((tried ? scale : 1) * before.error).epsilon(rounding));
                CHECK(after.ms == before.ms);
            }
        }
    }
}

TEST_CASE("where a scene shows no difference between levels, the quickest is chosen") {
    const BudgetQuestion question = blur_and_haze();
    LevelTrial trial;
    trial.distances["blur"] = {0, 0, 0};
    const Choice by_curves = LevelChooser(question).best(within_ms(7)).choice;
    const Choice by_scene = LevelChooser(in_scene(question, trial)).best(within_ms(7)).choice;
    CHECK(by_curves.levels == std::vector{1, 1});
    CHECK(by_scene.levels == std::vector{0, 1});
    CHECK(by_scene.error == Approx(0.02).epsilon(rounding));
}

TEST_CASE("a level that a scene shows to be worse than a quicker one is not chosen") {
    const BudgetQuestion question = blur_and_haze();
    LevelTrial trial;
    trial.distances["haze"] = {0.03, 0.05, 0}; // the middle one is farther from the best than the quickest
    const BudgetQuestion seen = in_scene(question, trial);
    for (double limit = 3; limit < 16; limit += 0.25)
        CHECK(LevelChooser(seen).best(within_ms(limit)).choice.levels[1] != 1);
}

TEST_CASE("what is not tried, has no choice or is one of one level stays as it is") {
    BudgetQuestion question = blur_and_haze();
    question.entries[0].role = BudgetEntry::Role::pinned;
    LevelTrial trial;
    trial.distances["blur"] = {0.5, 0};
    trial.distances["haze"] = {0};
    trial.distances["mist"] = {0.5, 0};
    CHECK(in_scene(question, trial) == question);
    CHECK(in_scene(question, {}) == question);
    trial.distances["haze"] = {0.5, 0.4, 0.3, 0}; // of another curve
    CHECK(in_scene(question, trial) == question);
}

TEST_CASE("nothing that a budget could choose, whatever the scene's errors are, is left untried") {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(0, 1);
    std::size_t left_out = 0;
    for (int round = 0; round < 200; ++round) {
        BudgetQuestion question = random_question(random, 4, 5);
        const Budget budget = within_ms(2 + 10 * unit(random));
        const std::vector<std::size_t> counts = options_to_try(question, budget);
        REQUIRE(counts.size() == question.entries.size());
        for (BudgetEntry& entry : question.entries) {
            for (LevelOption& option : entry.options)
                option.error *= unit(random);
        }
        const auto answer = LevelChooser(question).best(budget);
        for (std::size_t e = 0; e < counts.size(); ++e) {
            CAPTURE(round, e);
            const std::size_t options = question.entries[e].options.size();
            REQUIRE(counts[e] <= options);
            if (options < 2) CHECK(counts[e] == 0);
            left_out += options - counts[e];
            if (answer.fits && options > 1)
                CHECK(static_cast<std::size_t>(answer.choice.levels[e]) < counts[e]);
        }
    }
    CHECK(left_out > 0);
}

TEST_CASE("for a budget of error, levels up to the one behind the curves' choice are tried") {
    const BudgetQuestion question = blur_and_haze();
    CHECK(options_to_try(question, within_error(0.2)) == std::vector<std::size_t>{2, 2});
    CHECK(options_to_try(question, within_error(0.06)) == std::vector<std::size_t>{3, 3});
    CHECK(options_to_try(question, within_error(0.001)) == std::vector<std::size_t>{3, 3});
}
