// Bloom: light scattered in lens, sensor and eye, as a convolution with a pyramid of blurs. README.md has the
// model.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <array>
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
        .about("How far the light spreads: standard deviation of the widest part of the glow"),
    postfx::number("threshold", 1.0).range(0, 1000).about("Luminous pixels start here (threshold mode only)"),
    postfx::number("knee", 0.5).range(0, 1).about("Softness of the threshold, as a fraction of it"),
    postfx::color("tint", 1, 1, 1).range(0, 1).about("Colour that the glow is multiplied by"),
};
constexpr const char* attachments[] = {"emission"};

/// Sizes go up to 2^16 pixels, so a pyramid has at most 16 levels.
constexpr int max_levels = 16;
/// The widest blur of L octaves has a standard deviation of about 1.1 * 2^L pixels (1.08 to 1.22, see
/// README.md).
constexpr double octave_deviation = 1.1;
/// The energy of a level relative to the next wider one: the glow falls like r^-1.5 inside its radius.
constexpr double narrower_share = 0.70710678118654752;

/// The kernel as a sum of blurs, one per pyramid level.
struct Pyramid {
    int levels;                           ///< 1 is half resolution
    double fade;                          ///< below one octave the glow fades out instead of narrowing
    std::array<double, max_levels> share; ///< part of levels l and wider that comes from wider ones
};

/// Continuous in radius: the deepest level comes in with a weight that grows from 0.
Pyramid make_pyramid(double radius_pixels, int longer_side) {
    const double most = std::max(1.0, std::ceil(std::log2(longer_side)));
    const double octaves =
        std::min({std::log2(1 + radius_pixels / octave_deviation), most, static_cast<double>(max_levels)});
    Pyramid pyramid{std::max(1, static_cast<int>(std::ceil(octaves))), std::min(octaves, 1.0), {}};
    double wider = 0;
    for (int level = pyramid.levels; level >= 1; --level) {
        const double narrower_by = octaves - level;
        const double weight = narrower_by < 0 ? 1 + narrower_by : std::pow(narrower_share, narrower_by);
        pyramid.share[level - 1] = wider / (wider + weight);
        wider += weight;
    }
    return pyramid;
}

postfx::PlanImage pass_down_and_up(const postfx::Request& in, postfx::Builder& out, const Pyramid& pyramid) {
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
    for (int i = 1; i < pyramid.levels; ++i) {
        level[i] = out.pass(("down_" + std::to_string(i + 1)).c_str(), "bloom_down.glsl")
                       .reads("finer", level[i - 1], "nearest")
                       .scale_of(level[i - 1], 0.5);
    }
    postfx::PlanImage glow = level[pyramid.levels - 1];
    for (int i = pyramid.levels - 2; i >= 0; --i) {
        glow = out.pass(("up_" + std::to_string(i + 1)).c_str(), "bloom_up.glsl")
                   .reads("own", level[i], "nearest")
                   .reads("wider", glow, "nearest")
                   .value("wider_share", pyramid.share[i])
                   .scale_of(level[i], 1.0);
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
    const Pyramid pyramid =
        make_pyramid(in.number("radius") * in.height(), std::max(in.width(), in.height()));
    const double strength = in.number("intensity") * pyramid.fade;
    const double* tint = in.color("tint");
    // What is added may not lift a half float over its largest value; a weighted mean can't.
    const double ceiling = mode == scatter ? 3.4e38 : 65504;
    const postfx::PlanImage glow = pass_down_and_up(in, out, pyramid);
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
