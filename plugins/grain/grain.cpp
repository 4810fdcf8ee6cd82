// Film grain: noise with the statistics of a layer of opaque grains. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

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
    postfx::level("high",
                  "discs of two sizes on a lattice, seen through pixels: up to 14 numbers per channel"),
    postfx::level("reference", "up to 32 layers of discs at random places (Boolean model); slow"),
};

constexpr double pi = std::numbers::pi;
/// Diameter of film's discs per `size`: correlation at half its height at 0.58 of the size, in mid-tones.
constexpr double disc_per_size = 1.75;
/// Diameter of the disc whose spectrum medium's field is nearest to, in the lattice's unit (edges are sqrt(2/3) of it).
constexpr double medium_edges = 0.81649658 * disc_per_size / 1.22;

/// Discs of film as a pixel's square shows them. A disc of radius R has the variance R^2 / 4 along an axis, the square
/// 1 / 12; blurred by the square the disc has their sum, and the disc's area.
struct SeenDisc {
    /// As a smooth field's size: the diameter of the sharp disc that has that variance, pixels.
    double diameter;
    /// As a disc with an edge one pixel wide, clamp(reach - distance, 0, 1): pixels, and its integrals. From a reach of
    /// 1 on its area is pi ((reach - 1/2)^2 + 1/12), which is to be the disc's. Below it is a cone, between that and the one that
    /// has the variance of the square alone, 0.15 reach^2.
    double reach, area, area_of_square;
    double radius; ///< of the disc itself, pixels

    explicit SeenDisc(double size) {
        radius = 0.5 * disc_per_size * size;
        const double variance = radius * radius / 4 + 1.0 / 12;
        diameter = 4 * std::sqrt(variance);
        reach = radius * radius > 1.0 / 3 ? 0.5 + std::sqrt(radius * radius - 1.0 / 12)
                                          : std::sqrt(5.0 / 9 + 4 * radius * radius / 3);
        const double inner = reach - 1;
        area = inner < 0 ? pi * std::pow(reach, 3) / 3 : pi * (inner * inner + reach - 2.0 / 3);
        area_of_square = inner < 0 ? pi * std::pow(reach, 4) / 6 : pi * (inner * inner + 2 * reach / 3 - 0.5);
    }
};
/// Of the levels from low to high.
constexpr const char* sources[] = {"grain_pixels.glsl", "grain.glsl", "grain_gaussian.glsl"};

/// What mixes the reference's layers of discs: some are common to the channels, some a channel's own.
struct Layers {
    int common = 0, own = 0;
    double common_weight = 0, own_weight = 0; ///< of each layer; all together sum to 1
    double deviation = 0;                     ///< of the weighted mean, over that of one layer

    /// As many as are needed for that deviation in mid-tones, where one layer has the variance `of_one` of u (1 - u);
    /// more than 32 only make the noise more Gaussian than it is already. Two channels correlate by the common
    /// layers' share of the variance, which is to be 1 - color: only then may all of them be of one kind.
    Layers(double sigma, double of_one, double color) {
        const int count = static_cast<int>(std::clamp(std::floor(of_one / (sigma * sigma)), 2.0, 32.0));
        own = color == 0 ? 0 : color == 1 ? count : std::clamp(int(std::lround(color * count)), 1, count - 1);
        common = count - own;
        deviation = 1 / (std::sqrt((1 - color) * common) + std::sqrt(color * own));
        common_weight = deviation * std::sqrt((1 - color) / std::max(common, 1));
        own_weight = deviation * std::sqrt(color / std::max(own, 1));
    }
};

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

/// sigma: the noise's deviation over sqrt(u (1 - u)).
void declare_layers(const postfx::Request& in, postfx::Builder& out, const SeenDisc& disc, double sigma) {
    const double square_share = disc.area_of_square / disc.area;
    const Layers layers(sigma, std::exp2(square_share) - 1, in.number("color"));
    out.compose("grain_boolean.glsl")
        .int_value("key", key_of(in.integer("seed")))
        .value("frequency", 0.5 / disc.reach)
        .value("discs", 4 * disc.reach * disc.reach / disc.area)
        .value("square_share", square_share)
        .value("deviation", sigma / layers.deviation)
        .int_value("common_layers", layers.common)
        .int_value("own_layers", layers.own)
        .value("common_weight", layers.common_weight)
        .value("own_weight", layers.own_weight);
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("amount") == 0 && out.identity("amount is 0")) return;
    if (in.level() == classic) return declare_classic(in, out);
    const double size = in.number("size") * in.height(); // pixels
    // A pixel that holds many grains averages them: deviation times sqrt(area) is constant (Selwyn's law).
    const double sigma = in.number("amount") * std::min(1.0, size);
    const SeenDisc disc(size);
    if (in.level() == reference) return declare_layers(in, out, disc, sigma);
    // A channel is own * its field + joint * the sum of the three: its variance, (own + joint)^2 + 2 joint^2,
    // is to be 1; two channels then correlate by 1 - own^2, which is to be 1 - color.
    const double own = std::sqrt(in.number("color"));
    const double joint = (std::sqrt(3 - 2 * own * own) - own) / 3;
    postfx::PassDeclaration pass = out.compose(sources[in.level() - low]);
    pass.value("own", sigma * own).value("joint", sigma * joint).int_value("key", key_of(in.integer("seed")));
    if (in.level() == medium) pass.value("frequency", medium_edges / disc.diameter);
    if (in.level() == high)
        pass.value("frequency", 2 / disc.reach).value("radius_squared", disc.radius * disc.radius);
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
