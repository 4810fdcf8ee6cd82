// Bloom: light scattered in lens, sensor and eye, as a convolution with a pyramid of blurs. README.md has the
// model.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace {

constexpr const char* modes[] = {"scatter", "threshold", "emission"};
enum Mode { scatter, threshold, emission };

constexpr postfx::Parameter parameters[] = {
    postfx::choice("mode", modes)
        .about("scatter: share of all light, energy kept; threshold: bright light added; emission: glow of "
               "emitters"),
    postfx::number("intensity", 0.1)
        .range(0, 1)
        .identity_at(0)
        .about("Scattered share of the light (scatter) or strength of the added glow"),
    postfx::number("radius", 0.06)
        .range(0, 0.5)
        .in_unit("height")
        .identity_at(0)
        .about("How far the light spreads: standard deviation of the glow"),
    postfx::number("threshold", 1.0).range(0, 1000).about("Luminous pixels start here (threshold mode only)"),
    postfx::number("knee", 0.5).range(0, 1).about("Softness of the threshold, as a fraction of it"),
    postfx::color("tint", 1, 1, 1).range(0, 1).about("Colour that the glow is multiplied by"),
    postfx::number("firefly_guard", 0)
        .range(0, 1)
        .about("For the glow, a pixel is at most 1/this times as bright as the mean of its neighbours; 0: "
               "off"),
};
constexpr const char* attachments[] = {"emission"};

enum LevelIndex { low, medium, high, ultra, reference, classic };
constexpr postfx_level levels[] = {
    postfx::level("low", "Pyramid from a quarter of the size"),
    postfx::level("medium", "Pyramid from half the size"),
    postfx::level("high", "Pyramid from the full size, two widths per octave"),
    postfx::level("ultra", "Pyramid from the full size, two rounder widths per octave"),
    postfx::level("reference", "Full size throughout, four widths per octave; slow"),
    postfx::level("classic", "21x21 texels of a Gaussian some pixels apart; loses light, shows the texels"),
};

/// A blur along lines, of five texels: weights of the two nearest and of the two farthest.
struct Line {
    double near, far;
    constexpr double variance() const { return 2 * near + 8 * far; }
};
constexpr Line quarter{1.0 / 8, 0}, half{1.0 / 4, 0}, whole{1.0 / 4, 1.0 / 16};
/// Of the variance 1/n, and near to e^(-1 / n (1 - cos w)) up to the shortest waves. Dyadic as all weights, so that
/// half floats of constant light stay what they are.
constexpr Line gaussian_32{1.0 / 64, 0}, gaussian_16{15.0 / 512, 1.0 / 2048},
    gaussian_8{7.0 / 128, 1.0 / 512}, gaussian_4{25.0 / 256, 7.0 / 1024}, gaussian_2{5.0 / 32, 3.0 / 128};
constexpr Line high_lines[] = {half};
constexpr Line ultra_first[] = {quarter, whole}, ultra_lines[] = {whole};
constexpr Line reference_first[] = {gaussian_32, gaussian_32, gaussian_16, gaussian_8, gaussian_8,
                                    gaussian_4,  gaussian_2,  gaussian_2,  gaussian_2};
constexpr Line reference_lines[] = {whole, whole, whole, whole};

struct Setup {
    int block;                    ///< pixels per texel of the finest blurred image, on each axis
    bool halves;                  ///< or else the lines' texels move apart, at full size
    int linear_ups;               ///< steps up that interpolate linearly, from the picture on
    std::span<const Line> first;  ///< blurs at full size before the first halving
    std::span<const Line> lines;  ///< blurs between two halvings
    const char* line_format = ""; ///< rounding in half floats adds up over hundreds of lines
};
constexpr Setup setups[] = {
    {4, true, 1, {}, {}},
    {2, true, 2, {}, {}},
    {1, true, 1, high_lines, high_lines},
    {1, true, 1, ultra_first, ultra_lines},
    {1, false, 0, reference_first, reference_lines, "rgba32f"},
};

/// Variances of the passes' kernels on each axis, in squared texels of the finer of the two levels they join.
constexpr double variance_first_down = 0.75, variance_first_quarter = 2, variance_down = 1.75;
constexpr double variance_smooth_up = 1.25, variance_linear_up = 0.75, variance_linear_up_from_quarter = 2.75;

/// One blur after another makes every wider one. Each goes from an image to another of the same size (a line), or
/// by way of a coarser one.
struct Blur {
    int finer, coarser; ///< images: 0 is the picture's size, each next half of it
    double variance;    ///< that it adds on each axis [px^2]
    Line line{};        ///< if finer == coarser
    int step = 1;       ///< texels between those of the line
};

Blur halving(const Setup& setup, int finer) {
    if (finer == 0 && setup.block == 4)
        return {0, 2, variance_first_quarter + variance_linear_up_from_quarter};
    const double down = finer == 0 && setup.block == 2 ? variance_first_down : variance_down;
    const double up = finer < setup.linear_ups ? variance_linear_up : variance_smooth_up;
    return {finer, finer + 1, std::pow(4, finer) * (down + up)};
}

/// The blurs up to a sum of this variance, or as wide as makes sense in the picture.
std::vector<Blur> blurs_for(const Setup& setup, double largest_variance, int longer_side) {
    std::vector<Blur> blurs;
    double sum = 0;
    const auto add = [&](const Blur& blur) {
        if (sum >= largest_variance && !blurs.empty()) return;
        blurs.push_back(blur);
        sum += blur.variance;
    };
    for (const Line& line : setup.first)
        add({0, 0, line.variance(), line});
    const int last = std::max(setup.block / 2, static_cast<int>(std::ceil(std::log2(longer_side))));
    for (int size = 0; size < last && (blurs.empty() || sum < largest_variance);) {
        if (setup.halves) {
            add(halving(setup, size));
            size = blurs.back().coarser;
        }
        const double texel_area = std::pow(4, size);
        for (const Line& line : setup.lines) {
            add({setup.halves ? size : 0, setup.halves ? size : 0, texel_area * line.variance(), line,
                 setup.halves ? 1 : 1 << size});
        }
        if (!setup.halves) ++size;
    }
    return blurs;
}

/// The glow is a sum of Gaussians of which the share (v/widest)^1/4 has a variance below v: it falls like r^-1.5 up
/// to sqrt(widest), and has the variance widest/5.
constexpr double widest_over_mean = 5;

/// Shares of that sum for the picture itself and after each of the blurs: what lies between two variances goes to
/// both, so that mean and variance are kept. What is wider than the last goes to the last.
std::vector<double> shares_of(const std::vector<Blur>& blurs, double widest) {
    std::vector<double> shares(blurs.size() + 1, 0.0);
    double lower = 0;
    if (widest == 0) shares[0] = 1; // what underflowed
    const auto share_below = [&](double v) { return std::pow(v / widest, 0.25); };
    for (std::size_t i = 0; i < blurs.size(); ++i) {
        const double upper = lower + blurs[i].variance, end = std::min(upper, widest);
        if (end <= lower) break;
        const double share = share_below(end) - share_below(lower);
        const double mean = (end * share_below(end) - lower * share_below(lower)) / widest_over_mean / share;
        const double to_upper = (mean - lower) / (upper - lower);
        shares[i] += share * (1 - to_upper);
        shares[i + 1] += share * to_upper;
        lower = upper;
    }
    if (lower < widest) shares.back() += 1 - share_below(lower);
    return shares;
}

int divide_up(int size, int part) {
    return (size + part - 1) / part;
}

/// The picture's side in texels of an image of 1/2^size: the last of them may lie over the border.
double extent(int side, int size) {
    return side / std::pow(2, size);
}

/// What is made of the light that leaves its pixel, and the share that does not and is missing in it.
struct Glow {
    postfx::PlanImage image;
    int block; ///< pixels per texel
    double staying;
};

/// Declares the passes of one chain of blurs.
class Passes {
public:
    Passes(const postfx::Request& in, postfx::Builder& out) : in_(in), out_(out) {}

    /// Where nothing is brighter than where glow begins, none is added. (Scattering changes all light.)
    void ask_frame() {
        if (mode() == scatter) return;
        out_.skip_when("exact", "bloom_unlit.glsl",
                       mode() == emission ? "brightest emission" : "brightest light",
                       mode() == emission ? "none" : "start of the knee")
            .reads("source", source(), "nearest")
            .value("dark", dark());
    }

    /// The image that glows, at the picture's size: read as it is, or made by a pass.
    postfx::PlanImage source() { return mode() == emission ? out_.attachment("emission") : out_.color(); }
    postfx::PlanImage light() {
        return out_.pass("light", "bloom_light.glsl")
            .reads("source", source(), "nearest")
            .value("knee_start", knee_start())
            .value("knee_end", knee_end())
            .constant("BLOOM_HAS_THRESHOLD", has_threshold())
            .constant("BLOOM_HAS_FIREFLY_GUARD", has_guard());
    }

    /// The sum of all blurs but the first if that halves: bringing that up is left to compose(). The share that
    /// stays in its pixel goes in if lines make the glow that is added: then it costs nothing.
    Glow glow(const Setup& setup, const std::vector<Blur>& blurs, const std::vector<double>& shares) {
        halve(setup, blurs);
        const bool holds_all = mode() != scatter && setup.block == 1;
        postfx::PlanImage wider = sizes_[static_cast<std::size_t>(blurs.back().coarser)];
        double wider_share = shares.back();
        for (std::size_t i = blurs.size(); i-- > 0;) {
            const bool is_first = i == 0;
            if (is_first && blurs[i].finer != blurs[i].coarser) break;
            const double own_share = is_first && !holds_all ? 0 : shares[i];
            wider_share += own_share;
            wider = widen(setup, blurs[i], i, wider, wider_share > 0 ? own_share / wider_share : 0);
        }
        return {wider, setup.block, holds_all ? 0 : shares[0]};
    }

    Glow classic_glow() {
        const double deviation = in_.number("radius") * in_.height();
        return {out_.pass("classic", "bloom_classic.glsl")
                    .reads("light", light(), "nearest")
                    .int_value("stride", std::max(1, static_cast<int>(std::lround(deviation / 5)))),
                1, 0};
    }

    /// `intensity`: the value of that name, or 0 where there is no radius.
    void compose(const Glow& glow, double intensity) {
        const bool stays = mode() != scatter && glow.staying > 0;
        const bool is_light_apart = stays && (mode() == emission || is_light_made(glow.block));
        const double leaving = intensity * (1 - glow.staying), staying = intensity * glow.staying;
        const double *tint = in_.color("tint"), kept = mode() == scatter ? 1 - intensity : 0;
        auto pass = out_.compose(is_light_apart ? "bloom_over_light.glsl" : "bloom.glsl");
        pass.reads("glow", glow.image)
            .constant("BLOOM_BLOCK", glow.block)
            .value("uv_per_pixel", 1.0 / (glow.block * divide_up(in_.width(), glow.block)),
                   1.0 / (glow.block * divide_up(in_.height(), glow.block)))
            .value("gain", leaving * tint[0], leaving * tint[1], leaving * tint[2])
            .value("own", kept + staying * tint[0], kept + staying * tint[1], kept + staying * tint[2])
            .constant("BLOOM_HAS_THRESHOLD", is_light_apart ? 0 : has_threshold());
        if (is_light_apart) {
            pass.reads("light", sizes_[0], "nearest");
        } else {
            pass.constant("BLOOM_ADDS", mode() == scatter ? 0 : 1)
                .constant("BLOOM_STAYS", stays ? 1 : 0)
                .value("knee_start", knee_start())
                .value("knee_end", knee_end());
        }
    }

private:
    Mode mode() const { return static_cast<Mode>(in_.choice("mode")); }
    int has_threshold() const { return mode() == threshold ? 1 : 0; }
    /// The light is read as it is if the first step down can take it from the picture.
    bool is_light_made(int block) const { return block == 1 || has_guard() == 1; }
    int has_guard() const { return in_.number("firefly_guard") > 0 ? 1 : 0; }
    /// Nothing up to this brightness glows, also where filtering between pixels rounds up.
    double dark() const { return has_threshold() == 1 ? knee_start() * (1 - 1e-6) : 0; }
    double knee_start() const { return in_.number("threshold") * (1 - in_.number("knee")); }
    double knee_end() const { return in_.number("threshold") * (1 + in_.number("knee")); }

    /// The light at every size that the blurs go by.
    void halve(const Setup& setup, const std::vector<Blur>& blurs) {
        const bool is_made = is_light_made(setup.block);
        sizes_ = {is_made ? light() : source()};
        for (const Blur& blur : blurs) {
            if (blur.coarser == blur.finer) continue;
            if (blur.finer == 0 && setup.block > 1) {
                sizes_.resize(static_cast<std::size_t>(blur.coarser) + 1, sizes_[0]);
                sizes_.back() = first_down(setup, is_made ? 0 : has_threshold());
            } else {
                sizes_.push_back(
                    out_.pass(("down_" + std::to_string(blur.coarser)).c_str(), "bloom_down.glsl")
                        .reads("finer", sizes_.back())
                        .value("extent", extent(in_.width(), blur.finer), extent(in_.height(), blur.finer))
                        .scale_of(sizes_.back(), 0.5));
            }
        }
    }
    postfx::PlanImage first_down(const Setup& setup, int has_threshold) {
        const bool is_quarter = setup.block == 4;
        return out_
            .pass(is_quarter ? "down_2" : "down_1",
                  is_quarter ? "bloom_first_quarter.glsl" : "bloom_first_down.glsl")
            .reads("source", sizes_[0], is_quarter ? "linear" : "nearest")
            .value("knee_start", knee_start())
            .value("knee_end", knee_end())
            .constant("BLOOM_HAS_THRESHOLD", has_threshold)
            .scale(1.0 / setup.block);
    }

    /// One more blur of the wider ones' sum, mixed with the light at the finer size.
    postfx::PlanImage widen(const Setup& setup, const Blur& blur, std::size_t index, postfx::PlanImage wider,
                            double own_share) {
        const postfx::PlanImage own = sizes_[static_cast<std::size_t>(blur.finer)];
        if (blur.finer != blur.coarser) {
            return out_.pass(("up_" + std::to_string(blur.finer)).c_str(), "bloom_up.glsl")
                .reads("own", own, "nearest")
                .reads("wider", wider)
                .value("own_share", own_share)
                .value("extent", extent(in_.width(), blur.coarser), extent(in_.height(), blur.coarser))
                .constant("BLOOM_UP_IS_SMOOTH", blur.finer < setup.linear_ups ? 0 : 1)
                .scale_of(own, 1.0);
        }
        const std::string name = std::to_string(index);
        const postfx::PlanImage across =
            line(("across_" + name).c_str(), setup, blur, {blur.step, 0}, own, wider, 0);
        return line(("along_" + name).c_str(), setup, blur, {0, blur.step}, own, across, own_share);
    }
    struct Step {
        int x, y;
    };
    postfx::PlanImage line(const char* name, const Setup& setup, const Blur& blur, Step step,
                           postfx::PlanImage own, postfx::PlanImage wider, double own_share) {
        return out_.pass(name, "bloom_line.glsl")
            .reads("own", own, "nearest")
            .reads("wider", wider)
            .value("offset", step.x, step.y)
            .value("extent", extent(in_.width(), blur.finer), extent(in_.height(), blur.finer))
            .constant("BLOOM_LINE_IS_COARSE", blur.finer == 0 ? 0 : 1)
            .value("near", blur.line.near)
            .value("far", blur.line.far)
            .value("own_share", own_share)
            .format(setup.line_format)
            .scale_of(own, 1.0);
    }

    const postfx::Request& in_;
    postfx::Builder& out_;
    std::vector<postfx::PlanImage> sizes_; ///< the light at 1, 1/2, 1/4 ... of the picture's size
};

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("intensity") == 0 && out.identity("intensity is 0")) return;
    if (in.number("radius") == 0 && out.identity("radius is 0")) return;
    const Mode mode = static_cast<Mode>(in.choice("mode"));
    if (mode == emission && !in.has("emission")) return out.lacks("there is no emission attachment");
    if (mode == emission && in.is_empty("emission")
        && out.not_called_for("exact", "nothing in view emits light")) {
        return;
    }
    Passes passes(in, out);
    if (in.level() == classic) {
        passes.ask_frame();
        return passes.compose(passes.classic_glow(), in.number("radius") > 0 ? in.number("intensity") : 0);
    }

    const Setup& setup = setups[in.level()];
    const double widest = widest_over_mean * std::pow(in.number("radius") * in.height(), 2);
    const std::vector<Blur> blurs = blurs_for(setup, widest, std::max(in.width(), in.height()));
    const std::vector<double> shares = shares_of(blurs, widest);
    const bool stays = shares[0] == 1;
    if (stays && out.identity("the radius is too far below a pixel to count")) return;
    passes.ask_frame();
    passes.compose(passes.glow(setup, blurs, shares), stays ? 0 : in.number("intensity"));
}

/// Scattering averages. A threshold is steep, and a guard compares with neighbours: no bound is known for these.
postfx::Gain gain(const postfx::Request& in) {
    const bool averages = in.choice("mode") != threshold && in.number("firefly_guard") == 0;
    return averages ? postfx::Gain{} : postfx::Gain::unknown();
}

constexpr auto bloom = postfx::effect<plan>("bloom")
                           .about("Light scattered around bright places")
                           .with_parameters(parameters)
                           .reading(attachments)
                           .with_levels(levels, medium)
                           .with_gain<gain>();

} // namespace

POSTFX_MODULE(&bloom)
