// Darkens the picture towards its corners, as a lens does or as a photographer likes it.
#include <postfx/plugin.hpp>

#include <string>

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

constexpr postfx_level levels[] = {
    postfx::level("classic",
                  "1 - (1.2 r)^3 of texture coordinates: an ellipse, whatever the lens and the model"),
    postfx::level("medium", "exact up to rounding; other levels would be the same shader"),
};
enum LevelIndex { classic, medium };

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("strength") == 0 && out.identity("strength is 0")) return;
    const double codes = in.codes_of_share(in.number("strength"));
    if (codes <= postfx::negligible_codes
        && out.not_called_for("code", "the darkest corner changes " + std::to_string(codes)
                                          + " of an 8-bit code at most")) {
        return;
    }
    if (in.level() == classic) {
        out.compose("vignette_classic.glsl");
        return;
    }
    const postfx_camera& camera = in.camera();
    const bool natural = in.choice("model") == 0;
    if (natural && camera.orthographic
        && out.not_called_for("exact", "the natural falloff of a parallel projection is 1 everywhere")) {
        return;
    }
    // What half a pixel is worth. Natural: tangents of angles, of square pixels. Artistic: picture heights;
    // roundness 0 squeezes the width to the height.
    const double half_pixel = (natural ? camera.tan_half_fov : 0.5) / in.height();
    const double roundness = in.number("roundness"), aspect = double(in.width()) / in.height();
    const double across = natural ? 1 : roundness + (1 - roundness) / aspect;
    out.compose("vignette.glsl").value("scale", half_pixel * across, half_pixel);
}

constexpr auto vignette = postfx::effect<plan>("vignette")
                              .about("Darkens the picture towards its corners")
                              .with_parameters(parameters)
                              .with_levels(levels, medium)
                              .without_amplifying();

} // namespace

POSTFX_MODULE(&vignette)
