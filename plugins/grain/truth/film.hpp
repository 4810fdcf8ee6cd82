// Photographic film as opaque discs at random places: the Boolean model (Newson, Delon, Galerne 2017, "A stochastic
// film grain model for resolution-independent rendering").
#pragma once

#include <postfx/image.hpp>

#include <cstdint>

namespace postfx::host {

/// Diameter of the discs over the grain's size: their covariance falls to a half at 0.58 of the size, in mid-tones.
inline constexpr double disc_per_grain = 1.75;

/// Light of a layer of film is held to this range: none and all light have no grain, and infinitely many discs.
inline constexpr double least_grainy_light = 0x1p-24;
double grainy_light(double light);

/// What is known of one layer that is covered with the probability u everywhere.
class FilmStatistics {
public:
    /// Of the discs [px].
    explicit FilmStatistics(double diameter) : diameter_(diameter) {}

    /// Of two points at that distance [px], covered (1) or not (0).
    double point_covariance(double u, double distance) const;
    /// Of one pixel's mean over its square.
    double pixel_variance(double u) const;
    /// Of the means of two pixels so far apart.
    double pixel_covariance(double u, int across, int up) const;
    /// Pixels that have a covariance are less than this far apart on each axis.
    int reach() const;

private:
    double diameter_;
};

/// Layers of film, each a realisation of its own.
class Film {
public:
    Film(double diameter, std::uint64_t key) : diameter_(diameter), key_(key) {}

    /// Is a place [px from the picture's corner] of a layer covered, where `bareness` is that of its light? More
    /// light only ever adds discs.
    bool is_covered(int layer, double x, double y, double bareness) const;
    /// Of a cell of a disc's diameter squared, the probability that it holds no disc's middle.
    static double bareness(double light);

private:
    double diameter_;
    std::uint64_t key_;
};

} // namespace postfx::host
