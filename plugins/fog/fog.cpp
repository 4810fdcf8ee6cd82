// Fog of constant density, or one that thins out with height. README.md has the model and its limits.
#include <postfx/plugin.hpp>

namespace {

constexpr postfx::Parameter parameters[] = {
    postfx::number("density", 0.012)
        .range(0, 1)
        .in_unit("1/m")
        .identity_at(0)
        .about("Share of the light lost per metre at the base height; 3.9 / density is how far one sees"),
    postfx::number("height_falloff", 0.08)
        .range(0, 10)
        .in_unit("1/m")
        .about("How fast the fog thins out upwards, by e per 1 / height_falloff; 0: the same everywhere"),
    postfx::number("base_height", 0)
        .range(-100000, 100000)
        .in_unit("m")
        .about("Height in the world at which the fog has its density"),
    postfx::color("color", 0.05, 0.06, 0.08).range(0, 1000).about("Light that the fog scatters to the eye"),
    postfx::number("start", 0).range(0, 1000000).in_unit("m").about("There is no fog up to this distance"),
    postfx::number("max_opacity", 1)
        .range(0, 1)
        .identity_at(0)
        .about("Fog covers no more than this share, however far one looks"),
    postfx::toggle("sky", true)
        .about("Fog also lies before the sky, at infinity: above the horizon as much as the falloff leaves"),
};
constexpr const char* attachments[] = {"depth"};

constexpr postfx_level levels[] = {
    postfx::level("classic",
                  "constant density along the view axis: the same point is fogged less at the edge"),
    postfx::level("low",
                  "height fog in its usual form: off by up to 7e-4 near level rays, more below the fog"),
    postfx::level("medium", "exact up to rounding; higher levels would be the same shader"),
};
constexpr const char* sources[] = {"fog_classic.glsl", "fog_low.glsl", "fog.glsl"};
constexpr int medium = 2;

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("density") == 0) return out.identity("density is 0");
    if (in.number("max_opacity") == 0) return out.identity("max_opacity is 0");
    if (!in.has("depth")) return out.not_called_for("visible", "there is no depth attachment to fog by");
    out.compose(sources[in.level()]).reads("depth", out.attachment("depth"), "nearest");
}

constexpr auto fog = postfx::effect<plan>("fog")
                         .about("Fog that thins out with height")
                         .with_parameters(parameters)
                         .reading(attachments)
                         .with_levels(levels, medium);

} // namespace

POSTFX_MODULE(&fog)
