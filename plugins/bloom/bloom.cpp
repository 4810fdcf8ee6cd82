// Bloom: light scattered in lens, sensor and eye, as a convolution with a pyramid of blurs. README.md has the
// model.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

namespace {

constexpr const char* modes[] = {"scatter", "threshold", "emission"};
enum Mode { scatter, threshold, emission };

constexpr postfx::Parameter parameters[] = {
    postfx::choice("mode", modes)
        .about("scatter: share of all light, energy kept; threshold: bright light added; emission: glow of "
               "emitters"),
    postfx::number("intensity", 0.1)
        .range(0, 1)
        .identity_at(0)
        .about("Scattered share of the light (scatter) or strength of the added glow"),
    postfx::number("radius", 0.06)
        .range(0, 0.5)
        .in_unit("height")
        .identity_at(0)
        .about("How far the light spreads: standard deviation of the glow"),
    postfx::number("threshold", 1.0).range(0, 1000).about("Luminous pixels start here (threshold mode only)"),
    postfx::number("knee", 0.5).range(0, 1).about("Softness of the threshold, as a fraction of it"),
    postfx::color("tint", 1, 1, 1).range(0, 1).about("Colour that the glow is multiplied by"),
};
constexpr const char* attachments[] = {"emission"};

/// Sizes go up to 2^16 pixels, so a pyramid has at most 16 levels.
constexpr int max_levels = 16;
/// Energy of a level relative to the next wider one, 2^-1/2: the glow falls like r^-1.5 inside its radius.
constexpr double narrower_share = 0.70710678118654752;

/// Weight of each level's blur, widest last; continuous in `octaves`: the deepest level comes in from 0.
struct Weights {
    int levels;
    std::array<double, max_levels> level;

    explicit Weights(double octaves) : levels(std::max(1, static_cast<int>(std::ceil(octaves)))), level{} {
        level[levels - 1] = 1 + octaves - levels;
        double weight = std::pow(narrower_share, octaves - (levels - 1));
        for (int i = levels - 2; i >= 0; --i, weight *= narrower_share)
            level[i] = weight;
    }
    double sum() const { return std::accumulate(level.begin(), level.begin() + levels, 0.0); }
};

/// Below one octave the glow fades out instead of narrowing.
double fade(double octaves) {
    return std::min(octaves, 1.0);
}

/// Variances on each axis of the kernels of the passes, in squared texels of the finer of the two levels they
/// join.
constexpr double variance_down = 1.75, variance_first_down = 0.75;
constexpr double variance_tent = 2.75, variance_bilinear = 0.75;
/// Levels from this one on (0 is half resolution) are brought up to by the tent, finer ones by linear
/// interpolation.
constexpr int first_tent = 1;

/// Of the whole kernel on each axis [px^2]: variances of passes that follow each other add up.
double variance(double octaves) {
    const Weights weights(octaves);
    double level_variance = variance_first_down + variance_bilinear;
    double sum = 0;
    double texel_area = 4;
    for (int i = 0; i < weights.levels; ++i, texel_area *= 4) {
        sum += weights.level[i] * level_variance;
        level_variance += texel_area * (variance_down + (i < first_tent ? variance_bilinear : variance_tent));
    }
    return fade(octaves) * sum / weights.sum();
}

/// Depth of the pyramid whose kernel has this standard deviation, or as much as the picture allows.
double octaves_for(double deviation_pixels, int longer_side) {
    double low = 0;
    double high = std::clamp(std::ceil(std::log2(longer_side)), 1.0, static_cast<double>(max_levels));
    if (variance(high) <= deviation_pixels * deviation_pixels) return high;
    for (int i = 0; i < 40; ++i) { // to 16 * 2^-40 of an octave
        const double middle = (low + high) / 2;
        (variance(middle) < deviation_pixels * deviation_pixels ? low : high) = middle;
    }
    return high;
}

postfx::PlanImage pass_down_and_up(const postfx::Request& in, postfx::Builder& out, const Weights& weights) {
    const Mode mode = static_cast<Mode>(in.choice("mode"));
    const double start = in.number("threshold");
    const double half_width = start * in.number("knee");
    std::array<postfx::PlanImage, max_levels> level;
    level[0] = out.pass("down_1", "bloom_first_down.glsl")
                   .reads("source", mode == emission ? out.attachment("emission") : out.color(), "nearest")
                   .value("knee_start", start - half_width)
                   .value("knee_end", start + half_width)
                   .constant("BLOOM_HAS_THRESHOLD", mode == threshold ? 1 : 0)
                   .scale(0.5);
    for (int i = 1; i < weights.levels; ++i) {
        level[i] = out.pass(("down_" + std::to_string(i + 1)).c_str(), "bloom_down.glsl")
                       .reads("finer", level[i - 1], "nearest")
                       .scale_of(level[i - 1], 0.5);
    }
    postfx::PlanImage glow = level[weights.levels - 1];
    double wider = weights.level[weights.levels - 1];
    for (int i = weights.levels - 2; i >= 0; --i) {
        const double all = wider + weights.level[i];
        glow = out.pass(("up_" + std::to_string(i + 1)).c_str(), "bloom_up.glsl")
                   .reads("own", level[i], "nearest")
                   .reads("wider", glow, "nearest")
                   .value("wider_share", wider / all)
                   .constant("BLOOM_UP_IS_TENT", i < first_tent ? 0 : 1)
                   .scale_of(level[i], 1.0);
        wider = all;
    }
    return glow;
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    const Mode mode = static_cast<Mode>(in.choice("mode"));
    if (in.number("intensity") == 0) return out.identity("intensity is 0");
    if (in.number("radius") == 0) return out.identity("radius is 0");
    if (mode == emission && !in.has("emission")) {
        return out.not_called_for("exact", "there is no emission attachment, so nothing glows");
    }
    const double octaves = octaves_for(in.number("radius") * in.height(), std::max(in.width(), in.height()));
    const double strength = in.number("intensity") * fade(octaves);
    const double* tint = in.color("tint");
    // What is added may not lift a half float over its largest value; a weighted mean can't.
    const double ceiling = mode == scatter ? 3.4e38 : 65504;
    const postfx::PlanImage glow = pass_down_and_up(in, out, Weights(octaves));
    out.compose("bloom.glsl")
        .reads("glow", glow, "nearest")
        .value("kept", mode == scatter ? 1 - strength : 1)
        .value("gain", strength * tint[0], strength * tint[1], strength * tint[2])
        .value("ceiling", ceiling);
}

constexpr auto bloom = postfx::effect<plan>("bloom")
                           .about("Light scattered around bright places")
                           .with_parameters(parameters)
                           .reading(attachments);

} // namespace

POSTFX_MODULE(&bloom)
