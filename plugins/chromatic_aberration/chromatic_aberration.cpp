// Lateral chromatic aberration: a lens magnifies red and blue differently.
#include <postfx/plugin.hpp>

#include <algorithm>

namespace {

constexpr postfx::Parameter parameters[] = {
    postfx::number("strength", 0.003)
        .range(-0.05, 0.05)
        .identity_at(0)
        .in_unit("height")
        .about("Distance of the red from the blue image in the corner; negative: blue outside"),
};

// Wavelengths in micrometres at which the three channels are most sensitive.
constexpr double red_peak = 0.612, green_peak = 0.549, blue_peak = 0.464;

/// The part of a refractive index that depends on the wavelength, up to a factor: Cauchy's
/// n = A + B / wavelength^2.
constexpr double dispersion(double wavelength) {
    return 1 / (wavelength * wavelength);
}

/// Samples between green and the far end of that many pixels: at most 1.5 pixels apart, until there are 12.
int taps(double pixels) {
    return static_cast<int>(std::clamp(std::ceil(std::abs(pixels) / 1.5), 1.0, 12.0));
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    const double strength = in.number("strength");
    if (strength == 0) return out.identity("strength is 0");
    const double spread = dispersion(blue_peak) - dispersion(red_peak);
    const double red = strength * (dispersion(red_peak) - dispersion(green_peak)) / spread;
    const double blue = strength * (dispersion(blue_peak) - dispersion(green_peak)) / spread;
    // From heights in the corner to a share of the radius. The corner is at least half a height away, so no
    // share exceeds 0.1 and the picture can't be turned inside out.
    const double corner = 0.5 * std::hypot(1.0, double(in.width()) / in.height());
    out.compose("chromatic_aberration.glsl")
        .reads("picture", out.color(), "linear")
        .value("red", red / corner)
        .value("blue", blue / corner)
        .constant("CHROMATIC_ABERRATION_RED_TAPS", taps(red * in.height()))
        .constant("CHROMATIC_ABERRATION_BLUE_TAPS", taps(blue * in.height()));
}

constexpr auto chromatic_aberration = postfx::effect<plan>("chromatic_aberration")
                                          .about("Colour fringes that grow towards the corners")
                                          .with_parameters(parameters);

} // namespace

POSTFX_MODULE(&chromatic_aberration)
