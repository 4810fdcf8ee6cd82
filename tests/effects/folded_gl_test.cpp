// Values compiled into the shaders (PlanOptions::fold) give the picture that values in uniforms give, for every effect.
#include "hard_inputs.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr std::uint32_t random_seed = 20250311;

/// Constants that a compiler folds are rounded otherwise than at run time, by a step or two for each operation, and
/// an effect does some hundreds: 1e-4 of the value. Where an effect decides (which tile, which side of an edge),
/// another rounding may decide otherwise; that is rare, and bounded by this share of the pixels.
constexpr double tolerance = 1e-4;
constexpr double deciding_share = 0.005;

double differing_share(const Image& a, const Image& b) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.pixel_count(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double x = a.values[a.channels * i + c], y = b.values[b.channels * i + c];
            if (!(std::abs(x - y) <= tolerance * (1 + std::abs(y)))) {
                ++differing;
                break;
            }
        }
    }
    return static_cast<double>(differing) / static_cast<double>(a.pixel_count());
}

class Both {
public:
    void check(const ChainEntry& entry, const Input& input) {
        PlanOptions options = linear_output();
        const Image live = draw(entry, options, input);
        options.fold = true;
        CHECK(differing_share(draw(entry, options, input), live) <= deciding_share);
    }

private:
    Image draw(const ChainEntry& entry, const PlanOptions& options, const Input& input) {
        runner_.prepare(planner_.plan(Chain{{entry}}, facts_of(input), options));
        return runner_.draw(input);
    }

    Planner planner_;
    Runner runner_;
};

} // namespace

TEST_CASE("folded is live, for every effect and level") {
    std::mt19937 random(random_seed);
    for (const EffectPtr& effect : catalog().effects()) {
        Both both;
        const Input input = ordinary_input(effect->reads, usual_size, Camera::perspective(45, 0.1));
        Chain chain;
        ChainEntry entry = chain.add(catalog(), effect->id);
        const int levels = std::max<int>(1, static_cast<int>(effect->levels.size()));
        for (entry.level = 0; entry.level < levels; ++entry.level) {
            CAPTURE(effect->id, entry.level);
            both.check(entry, input);
            for (const ParameterInfo& parameter : effect->parameters) {
                const double share = static_cast<double>(random() >> 8) / 16777216.0;
                entry.set(parameter.id,
                          parameter.default_value[0] * (0.5 + share)); // near the default: nothing is refused
            }
            both.check(entry, input);
            entry.values = effect->default_values();
        }
    }
}
