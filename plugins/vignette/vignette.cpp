// Darkens the picture towards its corners, as a lens does or as a photographer likes it.
#include <postfx/plugin.hpp>

namespace {

constexpr const char* models[] = {"natural", "artistic"};
constexpr postfx::Parameter parameters[] = {
    postfx::choice("model", models)
        .constant()
        .about("natural: the cos^4 law for the camera's field of view; artistic: a shape of your own"),
    postfx::number("strength", 0.5)
        .range(0, 1)
        .identity_at(0)
        .about("Share of the darkening; with 1 natural is the full cos^4 law and artistic ends in black"),
    postfx::number("radius", 0.35)
        .range(0, 2)
        .in_unit("height")
        .about("Artistic: distance from the centre at which the darkening begins"),
    postfx::number("softness", 0.9)
        .range(0.01, 2)
        .in_unit("height")
        .about("Artistic: distance from there to the darkest"),
    postfx::number("roundness", 1)
        .range(0, 1)
        .about("Artistic: 1 is a circle, 0 an ellipse of the picture's shape"),
};

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("strength") == 0) return out.identity("strength is 0");
    const bool natural = in.choice("model") == 0;
    if (natural && in.camera().orthographic) {
        return out.not_called_for("exact", "the natural falloff of a parallel projection is 1 everywhere");
    }
    // Picture heights per half pixel; roundness 0 squeezes the width to the height.
    const double roundness = in.number("roundness"), aspect = double(in.width()) / in.height();
    const double unit = 0.5 / in.height();
    out.compose("vignette.glsl").value("scale", unit * (roundness + (1 - roundness) / aspect), unit);
}

constexpr auto vignette = postfx::effect<plan>("vignette")
                              .about("Darkens the picture towards its corners")
                              .with_parameters(parameters);

} // namespace

POSTFX_MODULE(&vignette)
