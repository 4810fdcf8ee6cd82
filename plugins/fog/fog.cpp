// Fog of constant density, or one that thins out with height. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <cmath>

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
    postfx::level("low",
                  "height fog in its usual form: off by up to 7e-4 near level rays, lost from high above"),
    postfx::level("medium", "exact up to rounding; higher levels would be the same shader"),
};
constexpr const char* sources[] = {"fog_classic.glsl", "fog_low.glsl", "fog.glsl"};
constexpr int medium = 2;

/// Of a pixel's ray, in lengths along the view axis.
double longest_ray(const postfx::Request& in) {
    const double up = in.camera().tan_half_fov, across = up * in.width() / in.height();
    return std::sqrt(1 + up * up + across * across);
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
                         .with_levels(levels, medium);

} // namespace

POSTFX_MODULE(&fog)
