// What is skipped because nothing calls for it makes no difference: for every effect, scene and moment, against the
// chain in which everything runs. An effect gets these checks by existing; none is named here. POSTFX_LONG=1 tries
// slow levels on every input.
#include "refusals.hpp"
#include "scene_inputs.hpp"

#include <plan/record.hpp>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr std::uint32_t random_seed = 20261122;
constexpr Size size{96, 54};

bool is_long() {
    const char* longer = std::getenv("POSTFX_LONG");
    return longer && *longer == '1';
}

/// Zero in every pixel.
bool is_black(const Image& image) {
    return std::all_of(image.values.begin(), image.values.end(), [](float value) { return value == 0; });
}

/// What a host could know of the scene, from the pixels: as tight as bounds can be.
SceneBounds bounds_of(const Input& input) {
    SceneBounds bounds;
    const auto depth = input.attachments.find("depth");
    if (depth != input.attachments.end()) {
        bounds.nearest = SceneBounds::infinity;
        bounds.farthest = bounds.reach = 0;
        const double up = input.camera.tan_half_fov();
        const double across = up * input.color.width / input.color.height;
        const double longest = std::sqrt(1 + up * up + across * across); // of a ray, per metre along the axis
        for (const float sample : depth->second.values) {
            if (sample == static_cast<float>(input.camera.sky_depth)) continue;
            const double z = input.camera.view_z(sample);
            bounds.nearest = std::min(bounds.nearest, z);
            bounds.farthest = std::max(bounds.farthest, z);
            bounds.reach = std::max(bounds.reach, z * longest);
        }
        if (bounds.farthest == 0) bounds.empty.emplace_back("depth");
    }
    for (const auto& [name, image] : input.attachments) {
        if (name != "depth" && is_black(image)) bounds.empty.push_back(name);
    }
    return bounds;
}

struct Outcome {
    Image picture;
    Report report;
};

/// How often what was skipped, by moment and kind.
using Tally = std::map<std::string, int>;

class Court {
public:
    explicit Court(const Catalog& effects = catalog()) : pinned_(effects) {}

    /// Nothing when an effect refuses its values, as it declares that it does; any other error is thrown.
    std::optional<Outcome> run(Chain chain, const Input& input, Skip skip, bool fuse = false) {
        chain.skip = skip;
        SceneFacts facts = facts_of(input);
        if (knows_bounds) facts.bounds = bounds_of(input);
        PlanOptions options = linear_output();
        options.fuse = fuse;
        std::optional<Plan> plan;
        try {
            plan = planner_.plan(chain, facts, options);
        } catch (const Refusal& refusal) {
            if (!pinned_.expects(refusal)) throw;
            ++refused;
            return std::nullopt;
        }
        runner_.prepare(std::move(*plan));
        Image picture = runner_.draw(input);
        return Outcome{std::move(picture), runner_.report()};
    }

    /// What was wrong, with skipping or at all, or "".
    std::string check(const Chain& chain, const Input& input) {
        std::string problem;
        for (const bool known : {true, false}) {
            knows_bounds = known;
            try {
                problem += check_once(chain, input);
            } catch (const Error& error) {
                problem += fmt::format("failed: {}\n", error.what());
            }
        }
        return problem;
    }

    std::string check_once(const Chain& chain, const Input& input) {
        const std::optional<Outcome> all = run(chain, input, Skip::nothing);
        if (!all) return "";
        ++cases;
        std::string problem;
        const Outcome exact = *run(chain, input, Skip::exact);
        count(exact.report, SkipKind::exact);
        if (!same_bits(exact.picture, all->picture)) {
            problem += fmt::format("exact skips change bits ({}): {}\n",
                                   first_difference(exact.picture, all->picture), skips(exact.report));
        }
        // In one pass with others, a compiler may round what is left in another order: by float steps, so within a
        // code. Without fusion there must not be a bit of difference.
        const Outcome code = *run(chain, input, Skip::code, true);
        count(code.report, SkipKind::code);
        const int codes =
            largest_code_difference(code.picture, run(chain, input, Skip::nothing, true)->picture);
        if (codes > 1) problem += fmt::format("code skips change {} codes: {}\n", codes, skips(code.report));
        return problem;
    }

    /// Of a skipped effect: "scene exact".
    static std::string how(const PlannedEffect& effect) {
        return fmt::format("{} {}", moment_word(effect.moment.value()), skip_kind_word(effect.kind.value()));
    }

    static std::string skips(const Report& report) {
        std::string text;
        for (const PlannedEffect& effect : report.effects) {
            if (effect.status != EffectStatus::skipped) continue;
            text += fmt::format("{} ({}: {}) ", effect.name, how(effect), effect.reason);
        }
        for (const PassReport& pass : report.passes) {
            if (pass.tiles_drawn && *pass.tiles_drawn < pass.tiles) {
                text += fmt::format("{} in {} of {} tiles ", pass.name, *pass.tiles_drawn, pass.tiles);
            }
        }
        return text;
    }

    void add(const Court& other) {
        cases += other.cases;
        refused += other.refused;
        for (const auto& [moment, times] : other.tally)
            tally[moment] += times;
    }

    void print(const std::string& what) const {
        fmt::print("{}: {} cases, {} plans refused as pinned", what, cases, refused);
        for (const auto& [moment, times] : tally)
            fmt::print(", {} x {}", times, moment);
        fmt::print("\n");
    }

    /// Does the host know the scene's bounds? If not, more is left to the frame.
    bool knows_bounds = true;
    int cases = 0, refused = 0;
    bool asks_frame = false, draws_tiles = false; ///< did any plan?
    Tally tally;

private:
    void count(const Report& report, SkipKind kind) {
        for (const PlannedEffect& effect : report.effects) {
            asks_frame = asks_frame || effect.decision >= 0;
            if (effect.status == EffectStatus::skipped && effect.kind == kind) ++tally[how(effect)];
        }
        if (kind != SkipKind::exact) return; // tiles are
        for (const PassReport& pass : report.passes) {
            draws_tiles = draws_tiles || pass.tiles_drawn.has_value();
            if (pass.tiles_drawn && pass.drawn.value_or(true) && *pass.tiles_drawn < pass.tiles)
                ++tally["tile"];
        }
    }

    static std::string first_difference(const Image& a, const Image& b) {
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            if (a.values[i] != b.values[i]) {
                const std::size_t pixel = i / static_cast<std::size_t>(a.channels);
                return fmt::format("at {}, {}: {} for {}", pixel % a.width, pixel / a.width, a.values[i],
                                   b.values[i]);
            }
        }
        return "only in what == does not see";
    }

    static double code_of(float light) {
        const double x = std::clamp<double>(light, 0, 1);
        return std::round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055));
    }
    static int largest_code_difference(const Image& a, const Image& b) {
        double largest = 0;
        for (std::size_t i = 0; i < a.values.size(); ++i)
            largest = std::max(largest, std::abs(code_of(a.values[i]) - code_of(b.values[i])));
        return static_cast<int>(largest);
    }

    Planner planner_;
    Runner runner_;
    PinnedRefusals pinned_;
};

/// Inputs of which each lacks something that an effect could be called for by.
std::vector<Named<Input>> poor_inputs() {
    const std::vector<std::string> all = {"depth", "normal", "emission", "ambient"};
    const Input ordinary = ordinary_input(all, size);
    std::vector<Named<Input>> inputs = {{"ordinary", ordinary}};
    Input dark = ordinary;
    for (float& value : dark.color.values)
        value *= 0.1f;
    inputs.push_back({"dark", dark});
    Input unlit = ordinary;
    fill(unlit.attachments.at("ambient"), 0);
    fill(unlit.attachments.at("emission"), 0);
    inputs.push_back({"no ambient light, no emitter", unlit});
    Input empty = ordinary;
    fill(empty.attachments.at("depth"), static_cast<float>(empty.camera.sky_depth));
    fill(empty.attachments.at("normal"), 0);
    inputs.push_back({"only sky", empty});
    Input wall = ordinary;
    wall.camera.focus_distance = 3;
    fill(wall.attachments.at("depth"), static_cast<float>(wall.camera.depth_at(3.001)));
    inputs.push_back({"a wall in focus", wall});
    // A corner out of focus, the rest a wall in focus.
    // A wall a millimetre away, in front of which thin fog does nothing.
    Input close = ordinary;
    fill(close.attachments.at("depth"), static_cast<float>(close.camera.depth_at(0.101)));
    for (float& value : close.color.values)
        value *= 0.2f;
    inputs.push_back({"a wall before the lens", close});
    Input corner = wall;
    for (int y = 0; y < size.height / 3; ++y) {
        for (int x = 0; x < size.width / 4; ++x)
            corner.attachments.at("depth").at(x, y, 0) =
                static_cast<float>(corner.camera.depth_at(0.4 + 0.1 * x));
    }
    inputs.push_back({"a corner out of focus", corner});
    return inputs;
}

const std::vector<Named<Input>>& inputs() {
    static const std::vector<Named<Input>> made = [] {
        std::vector<Named<Input>> list = poor_inputs();
        for (const std::string& name : RenderedScene::names())
            list.push_back({name, RenderedScene(name).input(size)});
        return list;
    }();
    return made;
}

double random_value(const ParameterInfo& parameter, std::mt19937& random) {
    const double share = share_of(random());
    switch (random() % 6) {
    case 0:
        return parameter.minimum;
    case 1:
        return parameter.identity.value_or(parameter.maximum);
    case 2:
    case 3:
        return parameter.default_value[0];
    default:
        return value_at(parameter, share);
    }
}

/// Effects that work on scene light in any order, then perhaps a tone map, then those for display light.
Chain random_chain(const Catalog& effects, std::mt19937& random) {
    Chain chain;
    for (const EffectStage stage :
         {EffectStage::scene, EffectStage::scene_to_display, EffectStage::display}) {
        std::vector<EffectPtr> fitting;
        for (const EffectPtr& effect : effects.effects()) {
            if (effect->stage == stage) fitting.push_back(effect);
        }
        std::shuffle(fitting.begin(), fitting.end(), random);
        const std::size_t most = stage == EffectStage::scene ? 4 : 1;
        const std::size_t count = fitting.empty() ? 0 : random() % (std::min(most, fitting.size()) + 1);
        for (std::size_t i = 0; i < count; ++i) {
            ChainEntry& entry = chain.add(effects, fitting[i]->id);
            for (const ParameterInfo& parameter : entry.effect->parameters)
                entry.set(parameter.id, random_value(parameter, random));
        }
    }
    return chain;
}

std::string text_of(const Chain& chain) {
    std::string text;
    for (const ChainEntry& entry : chain.entries) {
        text += entry.name + " {";
        for (std::size_t i = 0; i < entry.values.size(); ++i)
            text +=
                fmt::format("{}{}: {}", i ? ", " : "", entry.effect->parameters[i].id, entry.values[i][0]);
        text += "}; ";
    }
    return text;
}

Chain alone(const Catalog& effects, const std::string& id) {
    Chain chain;
    chain.add(effects, id);
    return chain;
}

} // namespace

TEST_CASE("with its defaults, every effect at every level may be skipped where it is") {
    Court all;
    for (const EffectPtr& effect : catalog().effects()) {
        Court court;
        Chain chain = alone(catalog(), effect->id);
        const int levels = std::max<int>(1, static_cast<int>(effect->levels.size()));
        for (int level = 0; level < levels; ++level) {
            // The slow levels share all of this but the shader: where they are not the default, on fewer inputs.
            const std::size_t every = is_long() || level == effect->default_level ? 1 : 3;
            chain.entries.front().level = level;
            for (std::size_t i = 0; i < inputs().size(); i += every) {
                const auto& [name, input] = inputs()[i];
                const std::string problem = court.check(chain, input);
                if (!problem.empty())
                    FAIL_CHECK(effect->id << ", level " << level << ", " << name << ": " << problem);
            }
        }
        // Whoever may leave out something at a moment does so on one of the inputs: each lacks something.
        CAPTURE(effect->id);
        CHECK((court.tally["frame exact"] > 0) == court.asks_frame);
        CHECK((court.tally["tile"] > 0) == court.draws_tiles);
        all.add(court);
    }
    all.print("defaults");
}

TEST_CASE("at each of its identities an effect that runs all the same changes nothing") {
    Court court;
    for (const EffectPtr& effect : catalog().effects()) {
        for (const ParameterInfo& parameter : effect->parameters) {
            if (!parameter.identity) continue;
            Chain chain = alone(catalog(), effect->id);
            chain.entries.front().set(parameter.id, *parameter.identity);
            for (const auto& [name, input] : inputs()) {
                const std::string problem = court.check(chain, input);
                if (!problem.empty())
                    FAIL_CHECK(effect->id << ", " << parameter.id << ", " << name << ": " << problem);
            }
        }
    }
    court.print("identities");
    CHECK(court.tally["configuration exact"] == court.cases);
}

TEST_CASE("random chains, skipping and not, give the same picture") {
    std::mt19937 random(random_seed);
    Court court;
    constexpr int chains = 500;
    for (int i = 0; i < chains; ++i) {
        const Chain chain = random_chain(catalog(), random);
        const auto& [name, input] = inputs()[random() % inputs().size()];
        const std::string problem = court.check(chain, input);
        if (!problem.empty()) FAIL_CHECK("chain " << i << ", " << name << ", " << text_of(chain) << problem);
    }
    court.print(fmt::format("random chains, seed {}", random_seed));
}

TEST_CASE("on either side of each threshold the picture is what all would give") {
    Court court;
    int thresholds = 0;
    // A number that does nothing at one end of its range has a threshold wherever the effect can do anything.
    int identities_at_ends = 0, thresholds_of_these = 0;
    const auto is_skipped = [&](const Chain& chain, const Input& input) -> std::optional<bool> {
        const auto outcome = court.run(chain, input, Skip::code);
        if (!outcome) return std::nullopt;
        return outcome->report.effects.front().status == EffectStatus::skipped;
    };
    for (const EffectPtr& effect : catalog().effects()) {
        for (const ParameterInfo& parameter : effect->parameters) {
            if (parameter.kind != ParameterKind::number) continue;
            const bool ends_in_identity =
                parameter.identity == parameter.minimum || parameter.identity == parameter.maximum;
            identities_at_ends += ends_in_identity;
            for (const auto& [name, input] : poor_inputs()) {
                Chain chain = alone(catalog(), effect->id);
                const auto at = [&, &input = input](double value) {
                    chain.entries.front().set(parameter.id, value);
                    return is_skipped(chain, input);
                };
                double low = parameter.minimum, high = parameter.maximum;
                const auto at_low = at(low), at_high = at(high);
                if (!at_low || !at_high || *at_low == *at_high) continue;
                for (int i = 0; i < 60 && std::nextafter(low, high) != high; ++i) {
                    const double middle = low + (high - low) / 2;
                    const auto found = at(middle);
                    if (!found) break;
                    (*found == *at_low ? low : high) = middle;
                }
                ++thresholds;
                thresholds_of_these += ends_in_identity && name == "ordinary";
                for (const double value : {low, high}) {
                    chain.entries.front().set(parameter.id, value);
                    const std::string problem = court.check(chain, input);
                    if (!problem.empty()) {
                        FAIL_CHECK(effect->id << ", " << parameter.id << " = " << value << ", " << name
                                              << ": " << problem);
                    }
                }
            }
        }
    }
    court.print(fmt::format("{} thresholds", thresholds));
    CHECK(thresholds_of_these == identities_at_ends);
}

TEST_CASE("small changes come out no larger than the effects say") {
    constexpr double share = 1e-3, light = 1e-3;
    std::mt19937 random(random_seed);
    const auto either_way = [&] { return static_cast<float>(random() >> 8) / 8388608.0f - 1; }; // -1 .. 1
    const Input& input = inputs().front().thing;
    Input by_share = input, by_light = input;
    for (float& value : by_share.color.values)
        value *= 1 + static_cast<float>(share) * either_way();
    for (float& value : by_light.color.values)
        value = std::max(0.0f, value + static_cast<float>(light) * either_way());
    for (const EffectPtr& effect : catalog().effects()) {
        Chain chain = alone(catalog(), effect->id);
        bool is_known = false; // at some of the values
        for (int set = 0; set < 12; ++set) {
            ChainEntry& entry = chain.entries.front();
            const SceneFacts facts = facts_of(input);
            const Codes of_light = codes_before(entry, facts, {1, 0}),
                        of_share = codes_before(entry, facts, {0, 1});
            if (std::isfinite(of_light.per_light)) {
                is_known = true;
                Court court;
                const auto base = court.run(chain, input, Skip::nothing);
                const auto shared = court.run(chain, by_share, Skip::nothing);
                const auto lit = court.run(chain, by_light, Skip::nothing);
                for (std::size_t i = 0; base && i < base->picture.values.size(); ++i) {
                    const double value = base->picture.values[i];
                    const double rounding =
                        1e-5 * (1 + std::abs(value)); // some dozens of float steps of either
                    const double allowed_share =
                        1.001 * share * (of_share.per_share * std::abs(value) + of_light.per_share)
                        + rounding;
                    const double allowed_light = 1.001 * light * of_light.per_light + rounding;
                    const double found_share = std::abs(shared->picture.values[i] - value);
                    const double found_light = std::abs(lit->picture.values[i] - value);
                    if (found_share > allowed_share || found_light > allowed_light) {
                        FAIL_CHECK(text_of(chain)
                                   << "pixel " << i / 4 << ": " << found_share << " of " << allowed_share
                                   << " allowed, " << found_light << " of " << allowed_light);
                        break;
                    }
                }
            }
            for (const ParameterInfo& parameter : effect->parameters)
                entry.set(parameter.id, random_value(parameter, random));
        }
        CAPTURE(effect->id);
        CHECK(is_known == (effect->gain != nullptr));
    }
}

TEST_CASE("effects that lie about being called for are found out") {
    Catalog liars;
    liars.load(std::string(POSTFX_FIXTURES) + "/postfx_fixture_liars.so");
    REQUIRE(liars.effects().size() == 5);
    Court court;
    for (const EffectPtr& liar : liars.effects()) {
        CAPTURE(liar->id);
        CHECK_THAT(court.check(alone(liars, liar->id), inputs().front().thing),
                   Catch::Contains("skips change"));
    }
}

TEST_CASE("only a pinned refusal is left out of the comparison") {
    Catalog fixtures;
    fixtures.load(std::string(POSTFX_FIXTURES) + "/postfx_fixture_refusing.so");
    Court court(fixtures);
    const auto problem = [&](const std::string& id) {
        Chain chain = alone(fixtures, id);
        chain.entries.front().set("amount", 0.75);
        return court.check(chain, Input{.color = inputs().front().thing.color});
    };
    CHECK(problem("pinned").empty());
    CHECK(court.cases == 0);
    CHECK(court.refused == 2); // with the scene's bounds and without
    CHECK_THAT(problem("unpinned"), Catch::Contains("nobody was told of this"));
    CHECK_THAT(problem("mistaken"), Catch::Contains("an image that does not exist"));
}
