// Looks must not change with resolution: what an effect does to a scene drawn at twice the size is, scaled down, what it
// does at the original size. No effect is named here; a box blur whose radius is in pixels shows that the test can fail.
#include "scene_inputs.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <array>
#include <cstdlib>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr Size size_1x{320, 180}, size_2x{640, 360};
constexpr int columns = 16, rows = 9; // cells of 20 x 20 pixels

/// How much less or more an effect may do at twice the size, as a share of what it does: a size in pixels is half as
/// large then, and blur, glow and grain alike change by about half.
constexpr double tolerance = 0.25;
/// Mean change of a display value (0..1) that nobody sees: a tenth of an 8-bit code.
constexpr double invisible = 0.1 / 255;

/// Blurred by that variance in pixels, with the binomial 1 4 6 4 1 across and down once for each.
Image softened(Image image, int variance) {
    constexpr float weights[] = {1 / 16.0f, 4 / 16.0f, 6 / 16.0f, 4 / 16.0f, 1 / 16.0f};
    for (int pass = 0; pass < 2 * variance; ++pass) {
        const Image from = image;
        const int dx = pass % 2, dy = 1 - dx;
        for (int y = 0; y < from.height; ++y) {
            for (int x = 0; x < from.width; ++x) {
                for (int c = 0; c < from.channels; ++c) {
                    float sum = 0;
                    for (int k = -2; k <= 2; ++k) {
                        sum += weights[k + 2]
                               * from.at(std::clamp(x + k * dx, 0, from.width - 1),
                                         std::clamp(y + k * dy, 0, from.height - 1), c);
                    }
                    image.at(x, y, c) = sum;
                }
            }
        }
    }
    return image;
}

/// Mean and standard deviation of every cell and channel: what grain of another size and phase, or a blur, does to the
/// brightness and to the liveliness of a place, whatever the pixels are.
using Look = std::vector<std::array<double, 2>>;

/// Light as a display shows it, so that one flame does not outweigh the picture.
double shown(double light) {
    return light / (1 + std::max(light, 0.0));
}

Image shown(Image image) {
    for (float& value : image.values)
        value = static_cast<float>(shown(value));
    return image;
}

/// The mean of 2 x 2 pixels.
Image halved(const Image& image) {
    Image half(image.width / 2, image.height / 2, image.channels);
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x) {
            for (int c = 0; c < half.channels; ++c) {
                half.at(x, y, c) = 0.25f
                                   * (image.at(2 * x, 2 * y, c) + image.at(2 * x + 1, 2 * y, c)
                                      + image.at(2 * x, 2 * y + 1, c) + image.at(2 * x + 1, 2 * y + 1, c));
            }
        }
    }
    return half;
}

Look look_of(const Image& picture) {
    Look look;
    const int width = picture.width / columns, height = picture.height / rows;
    for (int cell = 0; cell < columns * rows; ++cell) {
        const int left = cell % columns * width, bottom = cell / columns * height;
        for (int c = 0; c < 3; ++c) {
            double sum = 0, squares = 0;
            for (int y = bottom; y < bottom + height; ++y) {
                for (int x = left; x < left + width; ++x) {
                    const double value = static_cast<double>(picture.at(x, y, c));
                    sum += value;
                    squares += value * value;
                }
            }
            const double mean = sum / (width * height);
            look.push_back({mean, std::sqrt(std::max(0.0, squares / (width * height) - mean * mean))});
        }
    }
    return look;
}

/// Mean difference of means, and of deviations.
std::array<double, 2> apart(const Look& a, const Look& b) {
    std::array<double, 2> sum{};
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k)
            sum[k] += std::abs(a[i][k] - b[i][k]) / static_cast<double>(a.size());
    }
    return sum;
}

/// One scene at both sizes.
struct Pair {
    std::string name;
    Input once, twice;
};

/// The two richest; long runs (POSTFX_LONG=1) take all.
std::vector<std::string> scene_names() {
    const char* longer = std::getenv("POSTFX_LONG");
    if (longer && *longer == '1') return RenderedScene::names();
    return {"night_drive", "still_life"};
}

const std::vector<Pair>& scenes() {
    static const std::vector<Pair> drawn = [] {
        std::vector<Pair> pairs;
        for (const std::string& name : scene_names()) {
            RenderedScene scene(name);
            Pair pair{name, scene.input(size_1x), scene.input(size_2x)};
            // To a standard deviation of 1 pixel at the original size: what is compared is the look, not how a sampler
            // reconstructs detail that is as small as a pixel of one picture and not of the other.
            pair.once.color = softened(std::move(pair.once.color), 1);
            pair.twice.color = softened(std::move(pair.twice.color), 4);
            pairs.push_back(std::move(pair));
        }
        return pairs;
    }();
    return drawn;
}

class Comparison {
public:
    /// What is wrong, or "".
    std::string check(const ChainEntry& entry, const Pair& scene) {
        const bool is_display = entry.effect->stage == EffectStage::display;
        const auto looks = [&](const Input& input, bool is_twice) {
            Input given = input;
            if (is_display) given.color = shown(given.color);
            runner_.prepare(planner_.plan(Chain{{entry}}, facts_of(given), linear_output(Format::rgba16f)));
            const auto look = [&](const Image& picture) {
                const Image small = is_twice ? halved(picture) : picture;
                return look_of(entry.effect->stage == EffectStage::scene ? shown(small) : small);
            };
            return std::array{look(given.color), look(runner_.draw(given))};
        };
        Input again = scene.once;
        ++again.seed;
        const auto once = looks(scene.once, false), twice = looks(scene.twice, true);
        const auto other_seed = looks(again, false);
        // What the effect does, at either size; the scene's own edges differ a little and cancel.
        const auto change = [](const std::array<Look, 2>& pair) {
            Look made = pair[1];
            for (std::size_t i = 0; i < made.size(); ++i) {
                for (std::size_t k = 0; k < 2; ++k)
                    made[i][k] -= pair[0][i][k];
            }
            return made;
        };
        const Look nothing(once[0].size());
        const auto done_once = apart(change(once), nothing), done_twice = apart(change(twice), nothing);
        const auto differing = apart(change(once), change(twice));
        // Noise is another realisation at another size: what another seed changes is chance. 0 for all but noise.
        const auto chance = apart(change(once), change(other_seed));
        std::string problem;
        for (std::size_t k = 0; k < 2; ++k) {
            const double allowed = tolerance * std::max(done_once[k], done_twice[k]) + chance[k] + invisible;
            worst = std::max(worst, differing[k] / allowed);
            if (!(differing[k] <= allowed)) {
                problem += fmt::format(
                    "{} change by {:.5f} and, at twice the size, {:.5f}; they differ by {:.5f}, "
                    "allowed is {:.5f}; ",
                    k == 0 ? "means" : "deviations", done_once[k], done_twice[k], differing[k], allowed);
            }
        }
        return problem;
    }

    double worst = 0; ///< largest share of what is allowed

private:
    Planner planner_;
    Runner runner_;
};

/// With its defaults, and with every size that is given in heights doubled, so that small ones show.
std::vector<ChainEntry> entries_of(const Catalog& effects, const std::string& id, int level) {
    Chain chain;
    ChainEntry entry = chain.add(effects, id);
    entry.level = level;
    ChainEntry doubled = entry;
    bool has_sizes = false;
    for (std::size_t i = 0; i < entry.effect->parameters.size(); ++i) {
        const ParameterInfo& parameter = entry.effect->parameters[i];
        if (parameter.unit != "height") continue;
        doubled.set(parameter.id, std::min(2 * entry.values[i][0], parameter.maximum));
        has_sizes = true;
    }
    return has_sizes ? std::vector{entry, doubled} : std::vector{entry};
}

/// The naive version of an effect, kept so that its errors show: sizes in pixels are among them. It is measured and
/// printed, not failed.
bool is_naive(const EffectInfo& effect, int level) {
    return !effect.levels.empty() && effect.levels[static_cast<std::size_t>(level)].id == "classic";
}

int levels_of(const EffectInfo& effect) {
    return std::max<int>(1, static_cast<int>(effect.levels.size()));
}

} // namespace

TEST_CASE("no effect's look changes with the resolution") {
    REQUIRE(!catalog().effects().empty());
    int cases = 0;
    for (const EffectPtr& effect : catalog().effects()) {
        for (int level = 0; level < levels_of(*effect); ++level) {
            Comparison comparison;
            std::string worst_name;
            const std::string level_name =
                effect->levels.empty() ? "" : effect->levels[static_cast<std::size_t>(level)].id;
            for (const ChainEntry& entry : entries_of(catalog(), effect->id, level)) {
                for (const Pair& scene : scenes()) {
                    ++cases;
                    const double before = comparison.worst;
                    std::string problem;
                    try {
                        problem = comparison.check(entry, scene);
                        if (is_naive(*effect, level)) problem.clear();
                    } catch (const Error& error) {
                        problem = error.what();
                    }
                    if (comparison.worst > before) worst_name = scene.name;
                    if (!problem.empty())
                        FAIL_CHECK(effect->id << " " << level_name << ", " << scene.name << ": " << problem);
                }
            }
            fmt::print("{:<22} {:<10} at most {:3.0f} % of what is allowed ({})\n", effect->id, level_name,
                       100 * comparison.worst, worst_name);
        }
    }
    fmt::print("{} cases\n", cases);
}

TEST_CASE("an effect whose size is in pixels is found out") {
    Catalog fixtures;
    fixtures.load(std::string(POSTFX_FIXTURES) + "/postfx_fixture_blur.so");
    for (int level = 0; level < levels_of(*fixtures.find("blur")); ++level) {
        for (const Pair& scene : scenes()) {
            Comparison comparison;
            CHECK_FALSE(comparison.check(entries_of(fixtures, "blur", level).front(), scene).empty());
            fmt::print("blur in pixels, level {}, {}: {:.0f} %\n", level, scene.name, 100 * comparison.worst);
        }
    }
}
