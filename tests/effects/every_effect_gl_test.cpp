// What every effect of the catalog must survive, whatever it does: hostile pixels, depths, normals, sizes, values and
// times, and the shipped scenes. An effect, a level, a choice gets these checks by existing; none is named here. What an
// effect refuses is told beside it (refusals.hpp); any other error is a failure.
// POSTFX_LONG=1 draws more random values and tries every level on every depth and attachment.
#include "hard_inputs.hpp"
#include "refusals.hpp"
#include "scene_inputs.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <random>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr std::uint32_t random_seed = 20240607;
constexpr double one_week = 7 * 24 * 3600.0; // seconds

constexpr Size scene_size{96, 54}; // a circle or glow of a few per cent of the height has some pixels

bool is_long() {
    const char* longer = std::getenv("POSTFX_LONG");
    return longer && *longer == '1';
}

int random_sets() {
    return is_long() ? 200 : 40;
}

/// The shipped scenes, drawn once.
const std::vector<Named<Input>>& scenes() {
    static const std::vector<Named<Input>> drawn = [] {
        std::vector<Named<Input>> inputs;
        for (const std::string& name : RenderedScene::names())
            inputs.push_back({name, RenderedScene(name).input(scene_size)});
        return inputs;
    }();
    return drawn;
}

bool same_bits_in_all_channels(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels
           && std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

/// What rgba16f rounds to infinity. Asked of results in rgba32f too, since drivers differ in how they round on
/// storing; and infinity that was clamped only after it had spread is found.
constexpr float half_overflow = 65520;

/// Finite, as a half float too; false for NaN.
bool is_light(const float* pixel) {
    return std::abs(pixel[0]) < half_overflow && std::abs(pixel[1]) < half_overflow
           && std::abs(pixel[2]) < half_overflow;
}

/// Where the result is no light although that pixel's own colour is. Whatever the neighbours and the geometry are:
/// a bad pixel may stay what it is, it never spreads.
std::string spread(const Image& result, const Image& color) {
    std::size_t count = 0;
    std::string first;
    for (int y = 0; y < color.height; ++y) {
        for (int x = 0; x < color.width; ++x) {
            const float* pixel = result.pixel(x, y);
            if (is_light(pixel) || !is_light(color.pixel(x, y))) continue;
            if (count++ == 0) first = fmt::format("({}, {}) = {} {} {}", x, y, pixel[0], pixel[1], pixel[2]);
        }
    }
    return count == 0
               ? ""
               : fmt::format("{} pixels became no light that a half float holds, the first {}", count, first);
}

/// A few pixels, far and near ones among them where there is depth.
Image with_spots(Image color, float value) {
    for (const auto& [x, y] : {std::pair{1, 4}, std::pair{4, 1}, std::pair{4, 4}, std::pair{6, 7}}) {
        float* spot = color.pixel(color.width * x / 8, color.height * y / 8);
        std::fill(spot, spot + color.channels, value);
    }
    return color;
}

/// Where two pictures differ by more than 1e-4 although the pixel's own colour is light: sums of 65504 and of what it
/// stands for may be added up in another order.
std::string unlike(const Image& result, const Image& expected, const Image& color) {
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            if (!is_light(color.pixel(x, y))) continue;
            for (int c = 0; c < 3; ++c) {
                const float found = result.at(x, y, c), wanted = expected.at(x, y, c);
                if (std::abs(found - wanted) <= 1e-4f * (1 + std::abs(wanted))) continue;
                return fmt::format("({}, {}) = {}, beside infinite pixels {}", x, y, found, wanted);
            }
        }
    }
    return "";
}

/// What became of the cases; each counts once.
struct Tally {
    int ran = 0;     ///< drawn, and right
    int skipped = 0; ///< rightly nothing to do: identity values, nothing to read
    int refused = 0; ///< as pinned beside the effect
    int failed = 0;

    int cases() const { return ran + skipped + refused + failed; }
    Tally& operator+=(const Tally& other) {
        ran += other.ran;
        skipped += other.skipped;
        refused += other.refused;
        failed += other.failed;
        return *this;
    }
    void print(const std::string& name) const {
        fmt::print(
            "{:<22} {:5} hard cases: {:5} ran, {:3} refused as pinned, {:4} skipped as identity, {} failed\n",
            name, cases(), ran, refused, skipped, failed);
    }
};

/// One effect under test: its entry with defaults, and the tally of what was tried on it.
class Trial {
public:
    Trial(EffectPtr effect, PinnedRefusals& pinned) : effect_(std::move(effect)), pinned_(pinned) {}

    Input input(Size size = usual_size, const Camera& camera = Camera::perspective(45, 0.1)) const {
        return ordinary_input(effect_->reads, size, camera);
    }
    const EffectInfo& effect() const { return *effect_; }
    int levels() const { return std::max<int>(1, static_cast<int>(effect_->levels.size())); }

    ChainEntry entry(int level) const {
        return {.effect = effect_, .name = effect_->id, .level = level, .values = effect_->default_values()};
    }
    ChainEntry entry() const { return entry(effect_->default_level); }

    /// The levels that one case of a large sweep is tried at: all in long runs, otherwise the default and another one,
    /// which takes turns, so that a sweep costs the same however many levels there are.
    std::vector<int> sweep_levels() {
        std::vector<int> tried;
        turn_ = (turn_ + 1) % levels();
        for (int level = 0; level < levels(); ++level) {
            if (is_long() || level == effect_->default_level || level == turn_) tried.push_back(level);
        }
        return tried;
    }

    /// That level with its defaults, then with every other word of every choice and every other toggle.
    std::vector<Named<ChainEntry>> variants(int level) const {
        std::vector<Named<ChainEntry>> found{{"defaults", entry(level)}};
        for (const ParameterInfo& parameter : effect_->parameters) {
            const bool is_toggle = parameter.kind == ParameterKind::toggle;
            if (!is_toggle && parameter.kind != ParameterKind::choice) continue;
            const int words = is_toggle ? 2 : static_cast<int>(parameter.choices.size());
            for (int word = 0; word < words; ++word) {
                if (word == static_cast<int>(parameter.default_value[0])) continue;
                ChainEntry changed = entry(level);
                changed.set(parameter.id, word);
                found.push_back({fmt::format("{} = {}", parameter.id, word), std::move(changed)});
            }
        }
        return found;
    }

    /// Draw, draw something else over it, draw again: same bits, so that nothing is left unwritten, and no pixel of
    /// finite light lost.
    void check(const std::string& what, const ChainEntry& entry, const Input& input,
               Format working_format = Format::rgba32f) {
        attempt(what, entry, [&] {
            plan(entry, input, working_format);
            const Image first = runner_.draw(input);
            runner_.draw(poison(input));
            if (!same_bits_in_all_channels(first, runner_.draw(input))) {
                return std::string("drawn again over other pixels, the result is another");
            }
            return spread(first, input.color);
        });
    }

    /// Nothing may happen to the pixels, not even to bits that arithmetic loses.
    void check_identity(const std::string& what, const ChainEntry& entry, const Input& input) {
        attempt(what, entry, [&] {
            plan(entry, input, Format::rgba32f);
            return same_bits(runner_.draw(input), input.color) ? std::string() : "the input's bits changed";
        });
    }

    /// To pixels around it a finite one beyond what half floats hold is what an infinite one is: as bright as light gets.
    void check_brightest(const std::string& what, const ChainEntry& entry, Input input) {
        attempt(what, entry, [&] {
            const Image color = input.color;
            input.color = with_spots(color, infinite);
            plan(entry, input, Format::rgba32f);
            const Image expected = runner_.draw(input);
            const Image hostile = std::exchange(input.color, with_spots(color, 1e38f));
            return unlike(runner_.draw(input), expected, hostile);
        });
    }

    /// Anything but the identity at its defaults: otherwise the cases would prove nothing.
    void check_runs(int level) {
        const ChainEntry tried = entry(level);
        attempt("defaults", tried, [&] {
            const PlannedEffect planned =
                planner_.plan(Chain{{tried}}, facts_of(input()), linear_output()).effects.front();
            return planned.status == EffectStatus::skipped ? "skipped: " + planned.reason : std::string();
        });
    }

    Tally tally;
    std::vector<std::string> problems; ///< one for each case that failed

private:
    void plan(const ChainEntry& entry, const Input& input, Format working_format) {
        Plan plan = planner_.plan(Chain{{entry}}, facts_of(input), linear_output(working_format));
        is_skipped_ = plan.effects.front().status == EffectStatus::skipped;
        runner_.prepare(std::move(plan));
    }

    /// `body` returns what went wrong.
    template<class Body>
    void attempt(const std::string& what, const ChainEntry& entry, Body body) {
        is_skipped_ = false;
        std::string problem;
        try {
            problem = body();
        } catch (const Refusal& refusal) {
            if (pinned_.expects(refusal)) {
                ++tally.refused;
                return;
            }
            problem = fmt::format("refuses what is not in its refusals.txt: {}", refusal.what());
        } catch (const std::exception& error) {
            problem = fmt::format("failed: {}", error.what());
        }
        if (problem.empty()) {
            ++(is_skipped_ ? tally.skipped : tally.ran);
            return;
        }
        ++tally.failed;
        const std::string level =
            effect_->levels.empty() ? "" : ", " + effect_->levels[static_cast<std::size_t>(entry.level)].id;
        problems.push_back(fmt::format("{}{}, {}: {}", effect_->id, level, what, problem));
    }

    EffectPtr effect_;
    PinnedRefusals& pinned_;
    bool is_skipped_ = false; ///< the effect, in the case being tried
    int turn_ = -1;           ///< whose turn it is in sweep_levels
    Planner planner_;
    Runner runner_;
};

void try_defaults(Trial& trial) {
    for (int level = 0; level < trial.levels(); ++level)
        trial.check_runs(level);
}

void try_colors(Trial& trial) {
    for (const auto& [name, color] : hard_colors()) {
        Input input = trial.input();
        input.color = color;
        for (int level = 0; level < trial.levels(); ++level)
            trial.check(name, trial.entry(level), input);
    }
}

/// In the format that pictures are usually worked on, which overflows beyond 65504.
void try_half_precision(Trial& trial) {
    for (int level = 0; level < trial.levels(); ++level) {
        Input input = trial.input();
        trial.check("rgba16f", trial.entry(level), input, Format::rgba16f);
        fill(input.color, largest_half);
        trial.check("rgba16f, all pixels 65504", trial.entry(level), input, Format::rgba16f);
    }
}

void try_brightest(Trial& trial) {
    for (int level = 0; level < trial.levels(); ++level) {
        for (const auto& [name, entry] : trial.variants(level))
            trial.check_brightest(name + ", a pixel of 1e38", entry, trial.input());
    }
}

/// `name` holds the value at one pixel, then everywhere.
void try_attachment(Trial& trial, const Input& ordinary, const std::string& name, float value,
                    const std::string& what) {
    for (int level : trial.sweep_levels()) {
        Input input = ordinary;
        put_spot(input.attachments.at(name), value);
        trial.check(fmt::format("{} with a pixel of {}", what, value), trial.entry(level), input);
        fill(input.attachments.at(name), value);
        trial.check(fmt::format("{} of {} everywhere", what, value), trial.entry(level), input);
    }
}

void try_geometry(Trial& trial) {
    for (const auto& [name, camera] : hard_cameras()) {
        const Input ordinary = trial.input(usual_size, camera);
        for (int level = 0; level < trial.levels(); ++level)
            trial.check(name, trial.entry(level), ordinary);
        if (!ordinary.attachments.contains("depth")) continue;
        for (float depth :
             {0.0f, 1.0f, static_cast<float>(camera.sky_depth), not_a_number, infinite, -infinite})
            try_attachment(trial, ordinary, "depth", depth, name + ", depth");
    }
}

void try_attachments(Trial& trial) {
    const Input ordinary = trial.input();
    for (const auto& [name, image] : ordinary.attachments) {
        if (name == "depth") continue; // with its cameras, above
        for (float value : {0.0f, denormal, -1.0f, largest_half, not_a_number, infinite})
            try_attachment(trial, ordinary, name, value, name);
        Input without = ordinary;
        without.attachments.erase(name);
        for (int level = 0; level < trial.levels(); ++level)
            trial.check("without " + name, trial.entry(level), without);
    }
    const Input alone{.color = ordinary.color};
    for (int level = 0; level < trial.levels(); ++level)
        trial.check("without attachments", trial.entry(level), alone);
}

void try_sizes(Trial& trial) {
    for (Size size : hard_sizes) {
        for (int level = 0; level < trial.levels(); ++level)
            trial.check(text_of(size), trial.entry(level), trial.input(size));
    }
}

void try_times(Trial& trial) {
    for (double time : {0.0, one_week}) {
        for (std::uint32_t frame : {0u, 1u << 31, ~0u}) {
            Input input = trial.input();
            input.time = time;
            input.frame = frame;
            for (int level : trial.sweep_levels()) {
                trial.check(fmt::format("time {} s, frame {}", time, frame), trial.entry(level), input);
            }
        }
    }
}

/// Every level with every word of its choices, on ordinary, broken and the brightest light.
void try_choices(Trial& trial) {
    const Input ordinary = trial.input();
    Input brightest = ordinary;
    fill(brightest.color, largest_half);
    Input broken = ordinary;
    put_non_finite(broken.color);
    for (int level = 0; level < trial.levels(); ++level) {
        for (const auto& [what, entry] : trial.variants(level)) {
            trial.check(what, entry, ordinary);
            trial.check(what + ", non-finite pixels", entry, broken);
            trial.check(what + ", all pixels 65504, rgba16f", entry, brightest, Format::rgba16f);
        }
    }
}

void try_scenes(Trial& trial) {
    for (const auto& [name, input] : scenes()) {
        for (int level = 0; level < trial.levels(); ++level) {
            for (const auto& [what, entry] : trial.variants(level))
                trial.check(name + ", " + what, entry, input, Format::rgba16f);
        }
    }
}

/// Every parameter alone and all together at both ends, on ordinary, broken and the brightest light.
void try_extremes(Trial& trial) {
    const Input ordinary = trial.input();
    Input brightest = ordinary;
    fill(brightest.color, largest_half);
    Input broken = ordinary;
    put_non_finite(broken.color);
    const auto check = [&](const std::string& what, const ChainEntry& entry) {
        trial.check(what, entry, ordinary);
        trial.check(what + ", non-finite pixels", entry, broken);
        trial.check(what + ", all pixels 65504", entry, brightest);
        trial.check(what + ", all pixels 65504, rgba16f", entry, brightest, Format::rgba16f);
    };
    for (bool at_maximum : {false, true}) {
        const char* end = at_maximum ? "maximum" : "minimum";
        for (const ParameterInfo& parameter : trial.effect().parameters) {
            ChainEntry entry = trial.entry();
            entry.set(parameter.id, at_maximum ? parameter.maximum : parameter.minimum);
            check(fmt::format("{} at its {}", parameter.id, end), entry);
        }
        for (int level = 0; level < trial.levels(); ++level) {
            ChainEntry entry = trial.entry(level);
            for (const ParameterInfo& parameter : trial.effect().parameters)
                entry.set(parameter.id, at_maximum ? parameter.maximum : parameter.minimum);
            check(fmt::format("every parameter at its {}", end), entry);
        }
    }
}

/// A value of the range; ends and default come up often, since that is where branches are.
double random_value(const ParameterInfo& parameter, std::mt19937& random) {
    const double share = share_of(random());
    switch (random() % 6) {
    case 0:
        return parameter.minimum;
    case 1:
        return parameter.maximum;
    case 2:
        return parameter.default_value[0];
    default:
        return value_at(parameter, share);
    }
}

void try_random_values(Trial& trial) {
    std::mt19937 random(random_seed);
    const std::vector<Named<Camera>> cameras = hard_cameras();
    for (int set = 0; set < random_sets(); ++set) {
        ChainEntry entry = trial.entry(set % trial.levels());
        std::string what = fmt::format("random set {}:", set);
        for (std::size_t i = 0; i < trial.effect().parameters.size(); ++i) {
            const ParameterInfo& parameter = trial.effect().parameters[i];
            entry.set(parameter.id, random_value(parameter, random)); // rounds what counts in steps
            for (int c = 1; c < parameter.components(); ++c)
                entry.values[i][static_cast<std::size_t>(c)] = random_value(parameter, random);
            what += fmt::format(
                " {}={:.9g}", parameter.id,
                fmt::join(entry.values[i].begin(), entry.values[i].begin() + parameter.components(), ","));
        }
        const auto& [camera_name, camera] = cameras[random() % cameras.size()];
        const Size size = set % 4 == 0 ? hard_sizes[random() % std::size(hard_sizes)] : usual_size;
        Input input = trial.input(size, camera);
        put_spot(input.color, largest_half);
        if (random() % 2) put_non_finite(input.color);
        const Format format = random() % 2 ? Format::rgba16f : Format::rgba32f;
        trial.check(fmt::format("{}, {}, {}, {}", what, camera_name, text_of(size), format_info(format).name),
                    entry, input, format);
    }
}

void try_identities(Trial& trial) {
    Input input = trial.input();
    input.color = fragile_color();
    for (const ParameterInfo& parameter : trial.effect().parameters) {
        if (!parameter.identity) continue;
        for (int level = 0; level < trial.levels(); ++level) {
            ChainEntry entry = trial.entry(level);
            entry.set(parameter.id, *parameter.identity);
            trial.check_identity(fmt::format("{} = {}", parameter.id, *parameter.identity), entry, input);
        }
    }
}

/// Everything above, on one effect.
void try_all(Trial& trial) {
    for (auto* attempt :
         {try_defaults, try_colors, try_half_precision, try_brightest, try_geometry, try_attachments,
          try_sizes, try_times, try_choices, try_scenes, try_extremes, try_random_values, try_identities}) {
        attempt(trial);
    }
}

/// What README.md promises to have run, and to be right.
constexpr int promised_cases = 4000;

} // namespace

TEST_CASE("every effect of the catalog survives the hard cases") {
    REQUIRE(!catalog().effects().empty());
    fmt::print("{} random sets per effect, seed {}; {} scenes\n", random_sets(), random_seed,
               scenes().size());
    PinnedRefusals pinned(catalog());
    Tally all;
    for (const EffectPtr& effect : catalog().effects()) {
        Trial trial(effect, pinned);
        try_all(trial);
        trial.tally.print(effect->id);
        all += trial.tally;
        for (const std::string& problem : trial.problems)
            FAIL_CHECK(problem);
    }
    for (const std::string& line : pinned.unseen())
        FAIL_CHECK("no case was refused with: " << line);
    all.print("all effects");
    CHECK(all.failed == 0);
    CHECK(all.ran >= promised_cases);
}

TEST_CASE("a pinned refusal is counted as one; any other, and a mistake, is a failure") {
    Catalog fixtures;
    fixtures.load(std::string(POSTFX_FIXTURES) + "/postfx_fixture_refusing.so");
    PinnedRefusals pinned(fixtures);
    const auto tried = [&](const std::string& id, double amount) {
        Trial trial(fixtures.find(id), pinned);
        ChainEntry entry = trial.entry();
        entry.set("amount", amount);
        Input input = trial.input();
        input.attachments.clear();
        trial.check("tried", entry, input);
        REQUIRE(trial.tally.cases() == 1);
        return trial;
    };
    for (const char* id : {"pinned", "unpinned", "mistaken"})
        CHECK(tried(id, 0.5).tally.ran == 1);
    CHECK(tried("pinned", 0.75).tally.refused == 1);
    CHECK(pinned.unseen() == std::vector<std::string>{"pinned: this is never said"});
    CHECK_THAT(tried("unpinned", 0.75).problems.at(0), Catch::Contains("nobody was told of this"));
    CHECK_THAT(tried("mistaken", 0.75).problems.at(0), Catch::Contains("an image that does not exist"));
}
