// Film grain: noise with the statistics of a layer of opaque grains.
#include <postfx/plugin.hpp>

#include <algorithm>

namespace {

constexpr postfx::Parameter parameters[] = {
    postfx::number("amount", 0.03)
        .range(0, 1)
        .identity_at(0)
        .about("Standard deviation is this times sqrt(u (1 - u)) for display-linear light u"),
    postfx::number("size", 0.0015)
        .range(0.0002, 0.02)
        .in_unit("height")
        .logarithmic()
        .about("Distance between grains; 16 mm film has about 0.0015, 35 mm film 0.0007"),
    postfx::number("color", 0.3)
        .range(0, 1)
        .about("0: the same grain in all channels, 1: independent grain in each"),
};

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("amount") == 0) return out.identity("amount is 0");
    const double size = in.number("size") * in.height(); // pixels
    const bool clumps = size > 1;
    // A pixel that holds many grains averages them: deviation times sqrt(area) is constant (Selwyn's law).
    const double sigma = in.number("amount") * std::min(1.0, size);
    // A channel is own * its field + joint * the sum of the three: its variance, (own + joint)^2 + 2 joint^2,
    // is to be 1; two channels then correlate by 1 - own^2, which is to be 1 - color.
    const double own = std::sqrt(in.number("color"));
    const double joint = (std::sqrt(3 - 2 * own * own) - own) / 3;
    // The triangular lattice has edges of sqrt(2/3) in its own unit.
    out.compose("grain.glsl")
        .value("sigma", sigma)
        .value("frequency", std::sqrt(2.0 / 3.0) / size)
        .value("own", own)
        .value("joint", joint)
        .constant("GRAIN_CLUMPS", clumps ? 1 : 0);
}

constexpr auto grain = postfx::effect<plan>("grain")
                           .about("Film grain: strongest in the mid-tones, none in black and white")
                           .at_stage("display")
                           .with_parameters(parameters);

} // namespace

POSTFX_MODULE(&grain)
