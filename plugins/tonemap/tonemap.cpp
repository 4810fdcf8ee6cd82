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

constexpr auto tonemap = postfx::effect<plan>("tonemap")
                             .about("Brings scene-linear light into the display's range")
                             .at_stage("scene_to_display")
                             .with_parameters(parameters);

} // namespace

POSTFX_MODULE(&tonemap)
