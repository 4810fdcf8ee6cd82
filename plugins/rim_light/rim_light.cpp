// Light from behind that catches the edges of things, from the normals of what is seen. README.md has the model.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <string>

namespace {

constexpr const char* profiles[] = {"ramp", "fresnel"};
enum Profile { ramp, fresnel };

constexpr postfx::Parameter parameters[] = {
    postfx::number("strength", 0.05).range(0, 100).identity_at(0).about("Multiplies the light"),
    postfx::color("color", 0.55, 0.7, 1).range(0, 1000).about("Light added where a surface is seen edge on"),
    postfx::choice("profile", profiles)
        .constant()
        .about("ramp: linear in the cosine of normal and eye; fresnel: what a polished surface mirrors"),
    postfx::number("width", 0.25)
        .range(0, 10)
        .about("Ramp: cosine at which the rim begins; over 1 all of a surface has some, 0 is no rim"),
    postfx::number("refractive_index", 1.5)
        .range(1.01, 10)
        .logarithmic()
        .about("Fresnel: 1.33 is water, 1.5 glass and varnish, 2.4 diamond"),
};
constexpr const char* attachments[] = {"normal", "depth"};

constexpr postfx_level levels[] = {
    postfx::level("classic", "the ramp as (d + s) / s of the normal as it is; back faces are lit all over"),
    postfx::level("medium", "exact up to rounding; higher levels would be the same shader"),
};
enum Level : int { classic, medium };

/// Narrower rims are as wide as this: no cosine in float32 tells them apart, and a reciprocal stays finite.
constexpr double least_width = 1e-30;

/// A ramp of no width lights nothing, not even what is seen exactly edge on.
bool is_rimless(const postfx::Request& in) {
    const bool is_ramp = in.level() == classic || in.choice("profile") == ramp;
    return is_ramp && in.number("width") == 0;
}

void compose(const postfx::Request& in, postfx::Builder& out, postfx::PlanImage normal) {
    const bool is_classic = in.level() == classic;
    const double width = std::max(in.number("width"), least_width);
    const double strength = is_rimless(in) ? 0 : in.number("strength");
    const double* color = in.color("color");
    out.compose(is_classic ? "rim_light_classic.glsl" : "rim_light.glsl")
        .reads("normal", normal, "nearest")
        .value("light", strength * color[0], strength * color[1], strength * color[2])
        .value("slope", is_classic ? width : 1 / width)
        .constant("RIM_LIGHT_PARALLEL", in.camera().orthographic ? 1 : 0);
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    const double* color = in.color("color");
    if (in.number("strength") == 0 && out.identity("strength is 0")) return;
    if (color[0] == 0 && color[1] == 0 && color[2] == 0 && out.identity("color is black")) return;
    if (is_rimless(in) && out.identity("width is 0")) return;
    if ((in.is_empty("depth") || in.is_empty("normal"))
        && out.not_called_for("exact", "there is no surface in view")) {
        return;
    }
    const double codes = in.codes_of_light(in.number("strength") * std::max({color[0], color[1], color[2]}));
    if (codes <= postfx::negligible_codes
        && out.not_called_for("code", "the brightest rim changes " + std::to_string(codes)
                                          + " of an 8-bit code at most")) {
        return;
    }
    if (in.has("normal")) return compose(in, out, out.attachment("normal"));
    if (!in.has("depth")) {
        return out.lacks("there is neither a normal nor a depth attachment to find edges by");
    }
    const postfx::PlanImage rebuilt = out.pass("normal", "rim_light_normal.glsl")
                                          .reads("depth", out.attachment("depth"), "nearest")
                                          .format("rgba16f");
    compose(in, out, rebuilt);
}

constexpr auto rim_light = postfx::effect<plan>("rim_light")
                               .about("Light from behind that catches the edges of things")
                               .with_parameters(parameters)
                               .reading(attachments)
                               .with_levels(levels, medium)
                               .without_amplifying();

} // namespace

POSTFX_MODULE(&rim_light)
