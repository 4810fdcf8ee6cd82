// Fog of constant density, or one that thins out with height. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

constexpr postfx::Parameter parameters[] = {
    postfx::number("density", 0.02)
        .range(0, 1)
        .in_unit("1/m")
        .identity_at(0)
        .about("Share of the light lost per metre at the base height; 3.9 / density is how far one sees"),
    postfx::number("height_falloff", 0.04)
        .range(0, 10)
        .in_unit("1/m")
        .about("How fast the fog thins out upwards, by e per 1 / height_falloff; 0: the same everywhere"),
    postfx::number("base_height", 0)
        .range(-100000, 100000)
        .in_unit("m")
        .about("Height in the world at which the fog has its density"),
    postfx::color("color", 0.045, 0.055, 0.08).range(0, 1000).about("Light that the fog scatters to the eye"),
    postfx::number("start", 0).range(0, 1000000).in_unit("m").about("There is no fog up to this distance"),
    postfx::number("max_opacity", 1)
        .range(0, 1)
        .identity_at(0)
        .about("Fog covers no more than this share, however far one looks"),
    postfx::toggle("sky", false)
        .constant()
        .about("Fog lies before the sky too, which then fades out above the horizon as the falloff says; "
               "painted skies often have haze already"),
};
constexpr const char* attachments[] = {"depth"};

constexpr postfx_level levels[] = {
    postfx::level("classic",
                  "constant density along the view axis: the same point is fogged less at the edge"),
    postfx::level("medium", "exact up to rounding; higher levels would be the same shader"),
};
constexpr const char* sources[] = {"fog_classic.glsl", "fog.glsl"};
constexpr int medium = 1;

/// Of a pixel's ray, in lengths along the view axis.
double longest_ray(const postfx::Request& in) {
    const postfx_camera& camera = in.camera();
    const double half_height = camera.tan_half_fov, half_width = half_height * in.width() / in.height();
    const double across = half_width * (1 + std::abs(camera.principal_point[0]));
    const double up = half_height * (1 + std::abs(camera.principal_point[1]));
    return std::sqrt(1 + up * up + across * across);
}

/// The thickest that the fog can be on a ray of this scene, from its densest height: changes the light behind it by a
/// share, and adds its own.
bool is_below_a_code(const postfx::Request& in, postfx::Builder& out) {
    const postfx_scene& scene = in.scene();
    const double falloff = in.number("height_falloff");
    // Level classic has the same density everywhere; the exponent's bound is the shader's.
    const double exponent =
        falloff > 0 ? std::clamp(-falloff * (scene.lowest - in.number("base_height")), 0.0, 30.0) : 0.0;
    const double thickness =
        in.number("density") * std::exp(exponent) * std::max(scene.reach - in.number("start"), 0.0);
    const double opacity = std::min(1 - std::exp(-thickness), in.number("max_opacity"));
    const double* color = in.color("color");
    const double codes =
        in.codes_of_share(opacity) + in.codes_of_light(opacity * std::max({color[0], color[1], color[2]}));
    return codes <= postfx::negligible_codes
           && out.not_called_for("code", "the densest fog over the longest ray changes "
                                             + std::to_string(codes) + " of an 8-bit code at most");
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("density") == 0 && out.identity("density is 0")) return;
    if (in.number("max_opacity") == 0 && out.identity("max_opacity is 0")) return;
    if (!in.has("depth")) return out.lacks("there is no depth attachment to fog by");
    const double start = in.number("start");
    const bool covers_sky = in.toggle("sky");
    if (!covers_sky && in.is_empty("depth") && out.not_called_for("exact", "there is only sky in view"))
        return;
    if (!covers_sky && in.scene().reach <= start
        && out.not_called_for("exact", "all in view is nearer than the start")) {
        return;
    }
    if (!covers_sky && is_below_a_code(in, out)) return;
    if (!covers_sky && start > 0) {
        out.skip_when("exact", "fog_nearer.glsl", "farthest surface [m]", "start")
            .reads("depth", out.attachment("depth"), "nearest")
            .value("longest_ray", longest_ray(in));
    }
    out.compose(sources[in.level()])
        .reads("depth", out.attachment("depth"), "nearest")
        .constant("FOG_PARALLEL", in.camera().orthographic ? 1 : 0)
        .constant("FOG_HAS_START", in.number("start") > 0 ? 1 : 0);
}

constexpr auto fog = postfx::effect<plan>("fog")
                         .about("Fog that thins out with height")
                         .with_parameters(parameters)
                         .reading(attachments)
                         .with_levels(levels, medium)
                         .without_amplifying();

} // namespace

POSTFX_MODULE(&fog)
