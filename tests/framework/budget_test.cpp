// Which levels a budget buys: against trying every choice, and what is done with pins, skipped effects and missing
// curves.
#include <catch2/catch.hpp>

#include "budget_fixture.hpp"
#include "chain_fixture.hpp"

#include <nlohmann/json.hpp>

#include <chrono>

using namespace budget_fixture;
using postfx::BudgetAnswer;
using postfx::LevelChooser;
using postfx::Plan;

namespace {

/// Sums are made in another order than when every choice is tried.
constexpr double rounding = 1e-12;

/// The question with the answer's levels.
BudgetQuestion with(BudgetQuestion question, const Choice& choice) {
    for (std::size_t i = 0; i < question.entries.size(); ++i)
        question.entries[i].level = choice.levels.at(i);
    return question;
}

postfx::Curves curves_of_blur() {
    postfx::Curves curves;
    curves.base = {0.5, 1};
    curves.effects["blur"] = {{"low", {1, 2}, 0.1, 0.002}, {"high", {2, 4}, 0.01, 0}};
    return curves;
}

/// A plan in which everything runs, of one megapixel.
Plan plan_of(const postfx::Chain& chain) {
    Plan plan;
    plan.width = plan.height = 1000;
    for (const postfx::ChainEntry& entry : chain.entries)
        plan.effects.emplace_back().name = entry.name;
    return plan;
}

} // namespace

TEST_CASE("the choice is the best of all") {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        const BudgetQuestion question = random_question(random, 1 + round % 6, 5);
        const LevelChooser chooser(question);
        REQUIRE(chooser.loss() == 0);
        for (const double limit : {0.5, 2.0, 4.0, 8.0, 16.0}) {
            const BudgetAnswer answer = chooser.best(within_ms(limit));
            Best best = best_by_trying(question, within_ms(limit));
            if (best.fits) best = best_by_trying(question, within_error(postfx::same_error * best.error));
            CAPTURE(round, limit);
            CHECK(answer.fits == best.fits);
            CHECK(answer.choice.error == Approx(best.error).epsilon(rounding));
            CHECK(answer.choice.ms == Approx(best.ms).epsilon(rounding));
        }
        for (const double limit : {0.001, 0.01, 0.03, 0.1, 0.3}) {
            const BudgetAnswer answer = chooser.best(within_error(limit));
            const Best best = best_by_trying(question, within_error(limit));
            CAPTURE(round, limit);
            CHECK(answer.fits == best.fits);
            CHECK(answer.choice.error == Approx(best.error).epsilon(rounding));
            CHECK(answer.choice.ms == Approx(best.ms).epsilon(rounding));
        }
    }
}

TEST_CASE("what is predicted is what the levels add up to") {
    std::mt19937 random(8);
    const BudgetQuestion question = random_question(random, 6, 5);
    const BudgetAnswer answer = LevelChooser(question).best(within_ms(8), 1.25);
    const BudgetQuestion chosen = with(question, answer.choice);
    CHECK(answer.choice.ms == Approx(1.25 * chosen.ms()).epsilon(rounding));
    CHECK(answer.choice.error == Approx(chosen.error()).epsilon(rounding));
    CHECK(answer.choice.ms <= 8);
}

TEST_CASE("more time never gives a larger error") {
    std::mt19937 random(9);
    const LevelChooser chooser(random_question(random, 9, 6));
    double last_error = std::numeric_limits<double>::infinity(), last_ms = last_error;
    for (int i = 1; i < 400; ++i) {
        const double error = chooser.best(within_ms(0.1 * i)).choice.error;
        CHECK(error <= last_error);
        last_error = error;
        const double ms = chooser.best(within_error(0.001 * i)).choice.ms;
        CHECK(ms <= last_ms);
        last_ms = ms;
    }
}

TEST_CASE("when nothing fits, it is the cheapest or the most exact") {
    BudgetQuestion question;
    question.base_ms = 1;
    question.entries = {ladder("a", {{1, 0.1}, {2, 0.05}}), ladder("b", {{1, 0.1}, {3, 0.01}})};
    const LevelChooser chooser(question);
    const BudgetAnswer in_time = chooser.best(within_ms(2));
    CHECK_FALSE(in_time.fits);
    CHECK(in_time.choice.levels == std::vector<int>{0, 0});
    CHECK(in_time.choice.ms == 3);
    const BudgetAnswer exact = chooser.best(within_error(0.02));
    CHECK_FALSE(exact.fits);
    CHECK(exact.choice.levels == std::vector<int>{1, 1});
}

TEST_CASE("the runner-up tells what it lost by") {
    BudgetQuestion question;
    question.entries = {ladder("a", {{1, 0.5}, {4, 0.4}, {10, 0.1}})};
    const LevelChooser chooser(question);
    // 10 ms are a tenth above the limit, the error of the first is a quarter above the chosen one's.
    const BudgetAnswer tight = chooser.best(within_ms(9.1));
    CHECK(tight.choice.levels == std::vector<int>{1});
    REQUIRE(tight.runner_up);
    CHECK(tight.runner_up->lost_by == Budget::Of::ms);
    CHECK(tight.runner_up->choice.levels == std::vector<int>{2});
    const BudgetAnswer half = chooser.best(within_ms(5));
    REQUIRE(half.runner_up);
    CHECK(half.runner_up->lost_by == Budget::Of::error);
    CHECK(half.runner_up->choice.levels == std::vector<int>{0});
    const BudgetAnswer none = LevelChooser(BudgetQuestion{1, {}}).best(within_ms(5));
    CHECK(none.fits);
    CHECK_FALSE(none.runner_up);
}

TEST_CASE("of equal choices the last entries have the less exact level") {
    BudgetQuestion question;
    question.entries = {ladder("a", {{1, 0.2}, {2, 0.1}}), ladder("b", {{1, 0.2}, {2, 0.1}})};
    CHECK(LevelChooser(question).best(within_ms(3)).choice.levels == std::vector<int>{1, 0});
}

TEST_CASE("256 entries are quick, and near the best") {
    std::mt19937 random(10);
    const BudgetQuestion question = random_question(random, 256, 6);
    const auto start = std::chrono::steady_clock::now();
    const LevelChooser chooser(question);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    CHECK(took.count() < 10); // a fraction of a second, built for debugging on a busy machine some more
    CHECK(chooser.loss() > 0);
    CHECK(chooser.loss() < 0.25);
    // No choice is more exact than the relaxed problem's, in which levels may be mixed: time at a price, the best
    // price by bisection (Lagrange).
    const double limit = 600;
    const auto at_price = [&](double price) {
        double ms = question.base_ms, squares = 0;
        for (const BudgetEntry& entry : question.entries) {
            const auto cost = [&](const LevelOption& option) {
                return option.error * option.error + price * option.ms;
            };
            const auto best =
                std::min_element(entry.options.begin(), entry.options.end(),
                                 [&](const auto& a, const auto& b) { return cost(a) < cost(b); });
            ms += best->ms;
            squares += best->error * best->error;
        }
        return std::pair(ms, squares);
    };
    double bound = 0, low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double price = 0.5 * (low + high);
        const auto [ms, squares] = at_price(price);
        bound = std::max(bound, squares + price * (ms - limit));
        (ms > limit ? low : high) = price;
    }
    const BudgetAnswer answer = chooser.best(within_ms(limit));
    CHECK(answer.fits);
    CHECK(answer.choice.error >= std::sqrt(bound) * (1 - 1e-9)); // the bound itself is rounded
    CHECK(answer.choice.error <= postfx::same_error * std::sqrt(bound) * (1 + chooser.loss()));
}

TEST_CASE("a question is made of chain, curves and plan") {
    const postfx::Chain chain =
        chain_fixture::parse("effects: [blur, blur: {pin: low}, shade, blur: {enabled: false}]");
    Plan plan = plan_of(chain);
    plan.effects[3].status = postfx::EffectStatus::skipped;
    plan.effects[3].moment = postfx::Moment::configuration;
    plan.effects[3].reason = "enabled is false";
    const BudgetQuestion question = budget_question(chain, curves_of_blur(), plan);
    CHECK(question.base_ms == 1.5);
    REQUIRE(question.entries.size() == 4);
    CHECK(question.entries[0].role == BudgetEntry::Role::free);
    REQUIRE(question.entries[0].options.size() == 2);
    CHECK(question.entries[0].options[1] == LevelOption{1, "high", 6, 0.01, 0});
    CHECK(question.entries[1].role == BudgetEntry::Role::pinned);
    CHECK(question.entries[1].options.size() == 1);
    CHECK(question.entries[2].role == BudgetEntry::Role::unknown);
    CHECK(question.entries[2].reason == "it has no curve");
    CHECK(question.entries[3].role == BudgetEntry::Role::skipped);
    CHECK(question.entries[3].reason == "configuration: enabled is false");
    CHECK(question.entries[3].options.empty());

    // base 1.5, the first 3 or 6, the second stays at 3
    const LevelChooser chooser(question);
    CHECK(chooser.best(within_ms(8)).choice.levels == std::vector<int>{0, 0, 0, 1});
    const BudgetAnswer answer = chooser.best(within_ms(11));
    CHECK(answer.choice.levels == std::vector<int>{1, 0, 0, 1});
    CHECK(answer.choice.ms == 10.5);
    CHECK(answer.choice.error == Approx(std::hypot(0.01, 0.1)));

    postfx::Chain applied = chain;
    apply(answer.choice, applied);
    CHECK(applied.entries[0].level == 1);
    CHECK(applied.entries[1].level == 0);
}

TEST_CASE("levels that are on no curve are not chosen, and none is made up") {
    postfx::Chain chain = chain_fixture::parse("effects: [blur]");
    postfx::Curves curves = curves_of_blur();
    curves.effects["blur"].insert(curves.effects["blur"].begin() + 1, {"of_old", {1, 3}, 0.05, 0.003});
    BudgetQuestion question = budget_question(chain, curves, plan_of(chain));
    REQUIRE(question.entries[0].options.size() == 2);
    CHECK(question.entries[0].options[0].step_to_next == 0.005); // over the level that is no more
    curves.effects["blur"].erase(curves.effects["blur"].begin());
    question = budget_question(chain, curves, plan_of(chain));
    CHECK(question.entries[0].options.size() == 1);
    CHECK(LevelChooser(question).best(within_ms(0.1)).choice.levels == std::vector<int>{1});

    chain = chain_fixture::parse("effects: [blur: {pin: low}]");
    question = budget_question(chain, curves, plan_of(chain));
    CHECK(question.entries[0].role == BudgetEntry::Role::unknown);
    CHECK(question.entries[0].reason == "pinned to low, which is not on its curve");
}

TEST_CASE("an effect without levels has one point") {
    const postfx::Chain chain = chain_fixture::parse("effects: [shade]");
    postfx::Curves curves = curves_of_blur();
    curves.effects["shade"] = {{"", {0, 0.5}, 0, 0}};
    const BudgetQuestion question = budget_question(chain, curves, plan_of(chain));
    CHECK(question.entries[0].role == BudgetEntry::Role::free);
    CHECK(LevelChooser(question).best(within_ms(5)).choice.ms == 2);
}

TEST_CASE("a choice is told") {
    const postfx::Chain chain = chain_fixture::parse("effects: [blur, blur: {pin: low}, shade]");
    const BudgetQuestion question = budget_question(chain, curves_of_blur(), plan_of(chain));
    const LevelChooser chooser(question);
    CHECK(postfx::budget_text(within_ms(8), question, chooser.best(within_ms(8)))
          == "budget: 8 ms\n"
             "  blur    low            3.000 ms  error 0.1\n"
             "  blur_2  low            3.000 ms  error 0.1        pinned\n"
             "  shade   -                  ? ms  error ?          keeps its level: it has no curve\n"
             "  predicted 7.5 ms, 1.5 of them without any effect; error 0.141; fits\n"
             "  effects without a curve are in neither sum\n"
             "  runner-up: 10.5 ms, error 0.1 (blur high): takes longer\n");
    const auto json = nlohmann::json::parse(
        postfx::budget_json(within_error(0.05), question, chooser.best(within_error(0.05))));
    CHECK(json["budget"]["error"] == 0.05);
    CHECK(json["fits"] == false);
    CHECK(json["predicted_ms"] == 10.5);
    CHECK(json["effects"][0]["level"] == "high");
    CHECK(json["effects"][1]["role"] == "pinned");
    CHECK(json["effects"][2]["ms"].is_null());
    CHECK(json["runner_up"]["lost_by"] == "error");
    CHECK(json["runner_up"]["levels"]["blur"] == "low");
}
