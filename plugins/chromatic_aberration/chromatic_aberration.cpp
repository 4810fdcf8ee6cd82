// Lateral chromatic aberration: a lens magnifies red and blue differently. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>

namespace {

constexpr postfx::Parameter parameters[] = {
    postfx::number("strength", 0.003)
        .range(-0.05, 0.05)
        .identity_at(0)
        .in_unit("height")
        .about("Distance of the red from the blue image in the corner, if the optical axis is in the middle; "
               "negative: blue outside"),
};
constexpr const char* attachments[] = {"depth"};

enum LevelIndex { classic, low, medium, high, ultra, reference };
constexpr postfx_level levels[] = {
    postfx::level("classic", "three images of different size, by how far a pixel is out of focus"),
    postfx::level("low",
                  "three images of different size: ghosts instead of fringes where they lie far apart"),
    postfx::level("medium", "samples of the spectrum at most 1.5 pixels apart, up to 2 x 12"),
    postfx::level("high", "as medium, each sample the mean of an area, which keeps each pixel's light"),
    postfx::level("ultra", "samples at most 0.75 pixels apart, up to 2 x 48, areas of higher order"),
    postfx::level("reference", "as ultra, samples at most 0.25 pixels apart, up to 2 x 256; slow"),
};

/// How an integral over wavelengths is sampled, by level from medium on.
struct Sampling {
    double spacing; ///< largest distance of two samples, pixels
    int most;       ///< samples on either side of green; beyond, the spacing grows
    int radius; ///< 1: the sampler's linear filter; else of the pixels that an edge between two is rebuilt from
};
constexpr Sampling samplings[] = {{1.5, 12, 1}, {1.5, 12, 2}, {0.75, 48, 3}, {0.25, 256, 3}};

// Wavelengths in micrometres at which the three channels are most sensitive.
constexpr double red_peak = 0.612, green_peak = 0.549, blue_peak = 0.464;

/// The part of a refractive index that depends on the wavelength, up to a factor: Cauchy's
/// n = A + B / wavelength^2.
constexpr double dispersion(double wavelength) {
    return 1 / (wavelength * wavelength);
}
constexpr double spread = dispersion(blue_peak) - dispersion(red_peak);
constexpr double red_end = (dispersion(red_peak) - dispersion(green_peak)) / spread;
constexpr double blue_end = (dispersion(blue_peak) - dispersion(green_peak)) / spread;

/// Of a picture with the optical axis in its middle, from there, in heights.
double corner_distance(const postfx::Request& in) {
    return 0.5 * std::hypot(1.0, double(in.width()) / in.height());
}

/// How far red and blue lie apart where that is most, in the corner that is farthest from the optical axis [px].
double largest_distance(const postfx::Request& in) {
    const double* axis = in.camera().principal_point;
    const double farthest =
        0.5
        * std::hypot(1.0 + std::abs(axis[1]), double(in.width()) / in.height() * (1.0 + std::abs(axis[0])));
    return in.number("strength") * in.height() * (farthest / corner_distance(in));
}

/// Samples between green and the far end of that many pixels. None where nothing is displaced: a filtered sample at
/// the pixel's own place is not exactly the pixel.
int taps(double pixels, const Sampling& sampling) {
    if (pixels == 0) return 0;
    return static_cast<int>(
        std::clamp(std::ceil(std::abs(pixels) / sampling.spacing), 1.0, double(sampling.most)));
}

void declare_classic(const postfx::Request& in, postfx::Builder& out, double share) {
    if (!in.has("depth") || in.camera().focus_distance <= 0) {
        out.compose("chromatic_aberration_ghosts.glsl")
            .reads("picture", out.color(), "linear")
            .value("red", share * red_end)
            .value("blue", share * blue_end);
        return;
    }
    out.compose("chromatic_aberration_classic.glsl")
        .reads("picture", out.color(), "linear")
        .reads("depth", out.attachment("depth"), "nearest")
        .value("red", share * red_end)
        .value("blue", share * blue_end)
        .value("inverse_focus_distance", 1 / in.camera().focus_distance);
}

void declare_spectrum(const postfx::Request& in, postfx::Builder& out, double share) {
    const Sampling& sampling = samplings[std::max(0, in.level() - medium)];
    const double pixels = largest_distance(in);
    const bool linear = sampling.radius == 1;
    out.compose(linear ? "chromatic_aberration.glsl" : "chromatic_aberration_areas.glsl")
        .reads("picture", out.color(), linear ? "linear" : "nearest")
        .value("red", share * red_end)
        .value("blue", share * blue_end)
        .constant("CHROMATIC_ABERRATION_RED_TAPS", taps(pixels * red_end, sampling))
        .constant("CHROMATIC_ABERRATION_BLUE_TAPS", taps(pixels * blue_end, sampling))
        // Pixels that an area meets: its width is 1 + share.
        .constant("CHROMATIC_ABERRATION_RED_MET", share * red_end > 0 ? 3 : 2)
        .constant("CHROMATIC_ABERRATION_BLUE_MET", share * blue_end > 0 ? 3 : 2)
        .constant("CHROMATIC_ABERRATION_RADIUS", sampling.radius);
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("strength") == 0 && out.identity("strength is 0")) return;
    // From heights in the corner to a share of the radius. The corner is at least half a height away, so no
    // share exceeds 0.1 and the picture can't be turned inside out: the range of `strength` sees to that.
    const double share = in.number("strength") / corner_distance(in);
    const double farthest = std::abs(largest_distance(in)) * std::max(std::abs(red_end), std::abs(blue_end));
    if (farthest < 0.5 && out.not_called_for("visible", "no colour is displaced by half a pixel")) return;
    if (in.number("strength") == 0) return declare_spectrum(in, out, 0);
    switch (in.level()) {
    case classic:
        return declare_classic(in, out, share);
    case low:
        // A kernel that rises towards its end has its mean at 2/3.
        out.compose("chromatic_aberration_ghosts.glsl")
            .reads("picture", out.color(), "linear")
            .value("red", share * red_end * 2 / 3)
            .value("blue", share * blue_end * 2 / 3);
        return;
    default:
        return declare_spectrum(in, out, share);
    }
}

/// Filtered samples average; parabolas weigh differences by more than 1.
postfx::Gain gain(const postfx::Request& in) {
    return in.level() <= medium ? postfx::Gain{} : postfx::Gain::unknown();
}

constexpr auto chromatic_aberration = postfx::effect<plan>("chromatic_aberration")
                                          .about("Colour fringes that grow towards the corners")
                                          .with_parameters(parameters)
                                          .reading(attachments)
                                          .with_levels(levels, medium)
                                          .with_gain<gain>();

} // namespace

POSTFX_MODULE(&chromatic_aberration)
