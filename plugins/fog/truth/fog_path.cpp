#include "fog_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace postfx::host {
namespace {

/// Nothing is seen through a thickness from here on, in float64.
constexpr double opaque = 750;

/// Of positive abscissae, from the middle outwards; every second one is Gauss' (Piessens et al. 1983, QUADPACK).
constexpr std::array<double, 8> abscissae = {0,
                                             0.207784955007898467600689403773245,
                                             0.405845151377397166906606412076961,
                                             0.586087235467691130294144691693013,
                                             0.741531185599394439863864773280788,
                                             0.864864423359769072789712788640926,
                                             0.949107912342758524526189684047851,
                                             0.991455371120812639206854697526329};
constexpr std::array<double, 8> kronrod = {
    0.209482141084727828012999174891714, 0.204432940075298892414161999234649,
    0.190350578064785409913256402421014, 0.169004726639267902826583426598550,
    0.140653259715525918745189590510238, 0.104790010322250183839876322541518,
    0.063092092629978553290700663189204, 0.022935322010529224963732008058970};
constexpr std::array<double, 4> gauss = {
    0.417959183673469387755102040816327, 0.381830050505118944950369775488975,
    0.279705391489276667901467771423780, 0.129484966168869693270611432679082};

double thickness(const FogPath& path, double from, double to, int halvings) {
    const double middle = (from + to) / 2, half = (to - from) / 2;
    double fine = kronrod[0] * path.density_at(middle), coarse = gauss[0] * path.density_at(middle);
    for (std::size_t i = 1; i < abscissae.size(); ++i) {
        const double both =
            path.density_at(middle - half * abscissae[i]) + path.density_at(middle + half * abscissae[i]);
        fine += kronrod[i] * both;
        if (i % 2 == 0) coarse += gauss[i / 2] * both;
    }
    // The coarse rule is off by this much, the fine one by far less: float64's rounding. Nothing is seen of what is
    // less.
    if (halvings == 0 || half * std::abs(fine - coarse) <= 1e-9 * std::max(1.0, half * fine))
        return half * fine;
    return thickness(path, from, middle, halvings - 1) + thickness(path, middle, to, halvings - 1);
}

/// How both shares change per metre.
FogShares change(const FogPath& path, double along, const FogShares& now) {
    const double met = path.density_at(along) * now.transmittance;
    return {-met, met};
}

FogShares moved(const FogShares& from, const FogShares& by, double step) {
    return {from.transmittance + step * by.transmittance, from.opacity + step * by.opacity};
}

FogShares runge_kutta(const FogPath& path, double along, double step, const FogShares& now) {
    const FogShares a = change(path, along, now);
    const FogShares b = change(path, along + step / 2, moved(now, a, step / 2));
    const FogShares c = change(path, along + step / 2, moved(now, b, step / 2));
    const FogShares d = change(path, along + step, moved(now, c, step));
    return moved(moved(moved(moved(now, a, step / 6), b, step / 3), c, step / 3), d, step / 6);
}

} // namespace

double FogPath::density_at(double along) const {
    // More than e^500 on any path is opaque, and can still be multiplied by its length.
    return density * std::exp(std::min(-falloff * (height + rise * along), 500.0));
}

FogShares fog_by_thickness(const FogPath& path) {
    // Pieces that grow from the denser end, so that none is so long that the fog is missed.
    const bool from_eye = path.falloff * path.rise >= 0;
    double sum = 0;
    for (double near = 0, piece = 0.01; near < path.length && sum < opaque; near += piece, piece *= 2) {
        const double far = std::min(near + piece, path.length);
        sum += from_eye ? thickness(path, near, far, 30)
                        : thickness(path, path.length - far, path.length - near, 30);
    }
    return {std::exp(-sum), -std::expm1(-sum)};
}

FogShares fog_by_transfer(const FogPath& path) {
    constexpr double tolerance = 1e-11, nothing = 1e-18;
    FogShares now;
    double along = 0, step = 1e-3;
    while (along < path.length && now.transmittance > nothing) {
        step = std::min(step, path.length - along);
        const FogShares whole = runge_kutta(path, along, step, now);
        const FogShares half = runge_kutta(path, along, step / 2, now);
        const FogShares halves = runge_kutta(path, along + step / 2, step / 2, half);
        const double error = std::max(std::abs(halves.transmittance - whole.transmittance),
                                      std::abs(halves.opacity - whole.opacity))
                             / 15;
        if (error <= tolerance) {
            along = step < path.length - along ? along + step : path.length;
            now = moved(halves, {halves.transmittance - whole.transmittance, halves.opacity - whole.opacity},
                        1.0 / 15);
        }
        // Errors go with the step's fifth power; never much longer at once, lest fog ahead is stepped over. A step
        // far into dense fog may be too long for any number.
        const double fitting = 0.9 * std::pow(tolerance / std::max(error, 1e-300), 0.2);
        step *= std::isfinite(error) ? std::clamp(fitting, 0.1, 2.0) : 0.1;
    }
    return now;
}

} // namespace postfx::host
