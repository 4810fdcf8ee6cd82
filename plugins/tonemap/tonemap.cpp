// Brings scene-linear light of any brightness into the display's range.
#include <postfx/plugin.hpp>

namespace {

constexpr const char* operators[] = {"aces", "reinhard", "hable", "clamp"};
constexpr postfx::Parameter parameters[] = {
    postfx::number("exposure", 0).range(-10, 10).in_unit("stops").about("Brightness before the curve"),
    postfx::choice("operator", operators)
        .constant()
        .about(
            "aces: film-like, bright colours turn white; reinhard: keeps hue; hable: soft film; clamp: none"),
    postfx::number("white", 4)
        .range(1, 1000)
        .logarithmic()
        .about("Reinhard: the exposed luminance that becomes display white"),
};

void plan(const postfx::Request& in, postfx::Builder& out) {
    out.compose("tonemap.glsl").value("gain", std::exp2(in.number("exposure")));
}

/// The steepest slope of each curve, and the largest product of light and slope: what a share of light comes out as.
/// aces: the film curve's own 0.905 and 0.364, times 1 / 0.6 (slope only) and 2.21, the row of the matrices that
/// amplifies most. reinhard mixes with grey by the brightest channel: no bound is known.
postfx::Gain gain(const postfx::Request& in) {
    struct Steepest {
        double slope, share;
    };
    constexpr double unknown = std::numeric_limits<double>::infinity();
    constexpr Steepest steepest[] = {
        {0.905 / 0.6 * 2.21, 0.364 * 2.21}, {unknown, unknown}, {0.767, 0.323}, {1, 1}};
    const Steepest& curve = steepest[in.choice("operator")];
    return {0, std::exp2(in.number("exposure")) * curve.slope, curve.share};
}

constexpr auto tonemap = postfx::effect<plan>("tonemap")
                             .about("Brings scene-linear light into the display's range")
                             .at_stage("scene_to_display")
                             .with_parameters(parameters)
                             .with_gain<gain>();

} // namespace

POSTFX_MODULE(&tonemap)
