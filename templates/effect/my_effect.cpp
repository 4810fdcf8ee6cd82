// Draws colours towards shades of one tint, as toned photographs have them.
#include <postfx/plugin.hpp>

namespace {

constexpr postfx::Parameter parameters[] = {
    postfx::number("amount", 0.5)
        .range(0, 1)
        .identity_at(0)
        .about("0: colours as they are, 1: shades of the tint"),
    postfx::color("tint", 1, 0.75, 0.5).range(0, 1).about("Colour that a white pixel gets at amount 1"),
};

// Asked whenever a value or the picture's size changes: says that there is nothing to do, or declares passes.
void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("amount") == 0 && out.identity("amount is 0")) return;
    out.compose("my_effect.glsl");
}

constexpr auto declared = postfx::effect<plan>("my_effect")
                              .about("Draws colours towards shades of one tint")
                              .with_parameters(parameters);

} // namespace

POSTFX_MODULE(&declared)
