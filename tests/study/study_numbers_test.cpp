// Laws through points, spreads, which levels are worth having, the curve that a budget gets.
#include "study_findings.hpp"

#include <catch2/catch.hpp>

#include <study/fit.hpp>
#include <study/pareto.hpp>

#include <postfx/curves.hpp>

#include <cmath>
#include <limits>

using namespace postfx::host::study;
using namespace postfx::testing;

namespace {

constexpr double rounding = 1e-9; // of logarithms and sums of a few numbers

Points power_law(double factor, double exponent, std::vector<double> xs) {
    Points points;
    for (const double x : xs)
        points.emplace_back(x, factor * std::pow(x, exponent));
    return points;
}

std::vector<std::string> names(const EffectFindings& effect, const std::vector<std::size_t>& indices) {
    std::vector<std::string> result;
    for (const std::size_t i : indices)
        result.push_back(effect.levels[i].id);
    return result;
}

EffectFindings concluded(std::vector<Level> levels, double own_error = 0.001) {
    EffectFindings effect = made_effect(std::move(levels), own_error);
    conclude(effect);
    return effect;
}

} // namespace

TEST_CASE("the exponent of a power law is found, whatever its factor") {
    for (const double exponent : {-1.0, 0.0, 0.5, 1.0, 2.0})
        CHECK(exponent_of(power_law(3.7, exponent, {2, 4, 8, 16, 256})).value()
              == Approx(exponent).margin(rounding));
}

TEST_CASE("the exponent is by least squares: noise that cancels changes nothing") {
    // Logarithms (0, 0), (1, 2), (2, 2), (3, 4): slope (sum of dx dy) / (sum of dx dx) = 6 / 5.
    const Points points = {
        {1, 1}, {std::exp(1), std::exp(2)}, {std::exp(2), std::exp(2)}, {std::exp(3), std::exp(4)}};
    CHECK(exponent_of(points).value() == Approx(1.2).margin(rounding));
}

TEST_CASE("points that have no logarithm are left out, and one point has no exponent") {
    Points points = power_law(1, 2, {1, 2, 4});
    points.emplace_back(8, 0);
    points.emplace_back(16, -1);
    points.emplace_back(32, std::numeric_limits<double>::infinity());
    CHECK(exponent_of(points).value() == Approx(2).margin(rounding));
    CHECK_FALSE(exponent_of({{2, 3}}).has_value());
    CHECK_FALSE(exponent_of({{2, 3}, {2, 4}}).has_value());
    CHECK_FALSE(exponent_of({}).has_value());
}

TEST_CASE("a time curve goes through what lies on one, and is never negative") {
    const postfx::TimeCurve curve = fit_time({{0.25, 2.0}, {1, 5.0}});
    CHECK(curve.fixed_ms == Approx(1));
    CHECK(curve.ms_per_megapixel == Approx(4));
    CHECK(curve.exponent == 1);

    const postfx::TimeCurve steep = fit_time({{0.25, 0.5}, {1, 5.0}});
    CHECK(steep.fixed_ms == 0);
    CHECK(steep.at(0.25) == Approx(0.5));
    CHECK(steep.at(1) == Approx(5));
    CHECK(steep.exponent == Approx(std::log(10) / std::log(4)));

    const postfx::TimeCurve falling = fit_time({{0.25, 3.0}, {1, 2.0}});
    CHECK(falling.ms_per_megapixel == 0);
    CHECK(falling.fixed_ms > 2);
    CHECK(falling.fixed_ms < 3);

    const postfx::TimeCurve noise = fit_time({{0.25, -0.1}, {1, -0.2}});
    CHECK(noise.at(8) == 0);
    CHECK(fit_time({}).at(1) == 0);
    CHECK(fit_time({{1, 3}}).at(2) == Approx(3));
}

TEST_CASE("a spread is of its samples, and more rounds make the median surer") {
    const Spread spread = spread_of({5, 1, 2, 4, 3});
    CHECK(spread.median == 3);
    CHECK(spread.p10 == Approx(1.4));
    CHECK(spread.p90 == Approx(4.6));
    CHECK(spread.rounds == 5);
    Spread longer = spread;
    longer.rounds = 20;
    CHECK(longer.uncertainty() == Approx(spread.uncertainty() / 2));
    CHECK(spread_of({7}).uncertainty() > 0);
    CHECK(spread_of({}).rounds == 0);
}

TEST_CASE("a level is dominated by what is better in one and no worse in the other") {
    const EffectFindings effect =
        concluded({made_level("low", 1, 0.2), made_level("medium", 2, 0.1), made_level("high", 4, 0.12),
                   made_level("ultra", 8, 0.02), made_level("classic", 3, 0.4)});
    CHECK(effect.find("low")->dominated_by.empty());
    CHECK(effect.find("medium")->dominated_by.empty());
    CHECK(effect.find("high")->dominated_by == "medium");
    CHECK(effect.find("ultra")->dominated_by.empty());
    // Of all that dominate it, the closest is named.
    CHECK(effect.find("classic")->dominated_by == "medium");
    CHECK(names(effect, curve_of(effect)) == std::vector<std::string>{"low", "medium", "ultra"});
    CHECK(effect.find("low")->error.value() == Approx(0.2));
    CHECK(effect.find("medium")->ms.median == Approx(2));
    CHECK(effect.find("medium")->time.ms_per_megapixel == Approx(2));
}

TEST_CASE("what noise does not tell apart does not dominate") {
    Level blurry = made_level("blurry", 2.1, 0.1), plain = made_level("plain", 2, 0.1);
    for (Level* level : {&blurry, &plain}) {
        for (LevelOnScene& scene : level->scenes) {
            scene.costs[0].ms.p10 = 1;
            scene.costs[0].ms.p90 = 3;
        }
    }
    EffectFindings effect = concluded({plain, blurry});
    CHECK(effect.find("blurry")->dominated_by.empty());
    CHECK(effect.find("plain")->dominated_by.empty());
    // The curve still has to be one: of both, the quicker.
    CHECK(names(effect, curve_of(effect)) == std::vector<std::string>{"plain"});

    // Without the noise the same times decide.
    effect = concluded({made_level("plain", 2, 0.1), made_level("blurry", 2.1, 0.1)});
    CHECK(effect.find("blurry")->dominated_by == "plain");
}

TEST_CASE("below the truth's own error all are the same") {
    EffectFindings effect = concluded({made_level("high", 4, 0.008), made_level("ultra", 8, 0.004)}, 0.001);
    CHECK(effect.find("ultra")->dominated_by.empty());
    effect = concluded({made_level("high", 4, 0.008), made_level("ultra", 8, 0.004)}, 0.01);
    CHECK(effect.find("ultra")->dominated_by == "high");
}

TEST_CASE("the hull is what a string pulled tight from below touches") {
    CHECK(lower_hull({{0, 3}, {1, 2.5}, {2, 1}, {4, 0}, {5, 2}}) == std::vector<std::size_t>{0, 2, 3});
    CHECK(lower_hull({{2, 1}, {0, 3}}) == std::vector<std::size_t>{1, 0});
    CHECK(lower_hull({{1, 1}}) == std::vector<std::size_t>{0});
    CHECK(lower_hull({}).empty());
    // In logarithms: 1 ms and 0.2, 2 and 0.1, 4 and 0.05 lie on a line, 3 and 0.1 above it.
    const EffectFindings effect = concluded({made_level("low", 1, 0.2), made_level("medium", 3, 0.1),
                                             made_level("high", 4, 0.05), made_level("ultra", 16, 0.04)});
    CHECK(effect.find("low")->on_hull);
    CHECK_FALSE(effect.find("medium")->on_hull);
    CHECK(effect.find("high")->on_hull);
    CHECK(effect.find("ultra")->on_hull);
}

TEST_CASE("without a truth of pixels the error is the metric that stands for it, without any there is none") {
    EffectFindings effect = made_effect({made_level("low", 1, 0.2), made_level("high", 4, 0.1)});
    effect.judged_by = "";
    conclude(effect);
    CHECK_FALSE(effect.levels[0].error.has_value());
    CHECK(curve_of(effect).empty());
    CHECK(curves_of(made_findings(effect)).effects.empty());

    effect.metrics = {{"speckle", "px", "", false}, {"strength_error", "", "", true}};
    effect.levels[0].metrics = {5, 0.3};
    effect.levels[1].metrics = {5, 0.02};
    conclude(effect);
    CHECK(effect.levels[0].error == 0.3);
    CHECK(effect.levels[1].error == 0.02);
}

TEST_CASE("a curve is of the scenes' mean time, also where one is many times slower") {
    EffectFindings effect = made_effect({made_level("low", 1, 0.2)});
    for (auto& cost : effect.levels[0].scenes[1].costs)
        cost.ms.median *= 99;
    conclude(effect);
    CHECK(effect.levels[0].ms.median == Approx(50));
    CHECK(effect.levels[0].time.at(1) == Approx(50));
    CHECK(effect.levels[0].time.at(0.25) == Approx(12.5));
}

TEST_CASE("curves have what a budget reads: levels in order, with both numbers of time") {
    const EffectFindings effect = concluded({made_level("classic", 0.5, 0.4), made_level("high", 4, 0.05),
                                             made_level("low", 1, 0.2), made_level("slow", 5, 0.06)});
    const postfx::Curves curves = curves_of(made_findings(effect));
    CHECK(curves.device == "paper");
    CHECK(curves.base.ms_per_megapixel == 2);
    const auto& levels = curves.effects.at("haze");
    REQUIRE(levels.size() == 2); // what is usually done is no choice, however quick
    CHECK(levels[0].level == "low");
    CHECK(levels[1].level == "high");
    CHECK(levels[1].time.at(2) == Approx(8));
    CHECK(levels[1].error == Approx(0.05));
}
