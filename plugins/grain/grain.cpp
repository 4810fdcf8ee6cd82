// Film grain: noise with the statistics of a layer of opaque grains. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cstdint>

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
    postfx::integer("seed", 0).range(0, 65535).about(
        "Another number, another grain; for two films in one chain"),
};
constexpr const char* attachments[] = {"depth"};

enum LevelIndex { classic, low, medium, high, reference };
constexpr postfx_level levels[] = {
    postfx::level("classic",
                  "sine noise by how far a pixel is out of focus, the same in all light; wears out in time"),
    postfx::level("low", "one number per pixel: right in strength, but grains are pixels"),
    postfx::level("medium", "grains of the right size from 3 numbers per channel"),
    postfx::level("high", "Gaussian grain: 10 to 14 numbers per channel"),
    postfx::level("reference", "32 layers of discs at random places (Boolean model); slow"),
};

/// Lattice points per `size`, and what the points mean: medium's triangular lattice has edges of sqrt(2/3) in its own
/// unit, high's kernel ends at 2 of its edges, reference's discs have diameter 1. The factors give all three the
/// same correlation at half its height.
struct Field {
    const char* source;
    double frequency;
};
constexpr Field fields[] = {
    {"grain.glsl", 0.81649658}, {"grain_gaussian.glsl", 1 / 0.45}, {"grain_boolean.glsl", 1 / 1.75}};
constexpr int layers_of_discs = 32;

/// A word for the hash, as int_value() can pass it on.
int key_of(int seed) {
    return static_cast<int>(static_cast<std::uint32_t>(seed) * 0xc2b2ae35u);
}

void declare_classic(const postfx::Request& in, postfx::Builder& out) {
    if (!in.has("depth") || in.camera().focus_distance <= 0) {
        out.compose("grain_classic.glsl");
        return;
    }
    out.compose("grain_classic_focus.glsl")
        .reads("depth", out.attachment("depth"), "nearest")
        .value("inverse_focus_distance", 1 / in.camera().focus_distance);
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("amount") == 0 && out.identity("amount is 0")) return;
    if (in.level() == classic) return declare_classic(in, out);
    const double size = in.number("size") * in.height(); // pixels
    // A pixel that holds many grains averages them: deviation times sqrt(area) is constant (Selwyn's law).
    const double sigma = in.number("amount") * std::min(1.0, size);
    // A channel is own * its field + joint * the sum of the three: its variance, (own + joint)^2 + 2 joint^2,
    // is to be 1; two channels then correlate by 1 - own^2, which is to be 1 - color.
    const double own = std::sqrt(in.number("color"));
    const double joint = (std::sqrt(3 - 2 * own * own) - own) / 3;
    const int key = key_of(in.integer("seed"));
    if (in.level() == low || size <= 1) {
        out.compose("grain_pixels.glsl")
            .value("own", sigma * own)
            .value("joint", sigma * joint)
            .int_value("key", key)
            .constant("GRAIN_NUMBERS", in.level() >= high ? 4 : 1);
        return;
    }
    const Field& field = fields[in.level() - medium];
    out.compose(field.source)
        .value("own", sigma * own)
        .value("joint", sigma * joint)
        .int_value("key", key)
        .value("frequency", field.frequency / size)
        .constant("GRAIN_LAYERS", layers_of_discs);
}

/// u + n sqrt(u (1 - u)), its second part cut at the nearer end: at most twice as steep as u up to 1, as steep
/// beyond. The discs of the reference come and go with the light.
postfx::Gain gain(const postfx::Request& in) {
    return in.level() == reference ? postfx::Gain::unknown() : postfx::Gain{1, 2, 2};
}

constexpr auto grain = postfx::effect<plan>("grain")
                           .about("Film grain: strongest in the mid-tones, none in black and white")
                           .at_stage("display")
                           .with_parameters(parameters)
                           .reading(attachments)
                           .with_levels(levels, medium)
                           .with_gain<gain>();

} // namespace

POSTFX_MODULE(&grain)
