// Fog along a ray, by quadrature: no closed form of any integral.
#pragma once

#include <postfx/camera.hpp>

namespace postfx::host {

/// Density density * exp(-falloff * (height - base_height)) [1/m] along a straight line.
struct FogPath {
    double density = 0, falloff = 0;
    double height = 0; ///< of the line's beginning over the fog's base [m]
    double rise = 0;   ///< metres upwards per metre of the line
    double length = 0; ///< metres, finite

    double density_at(double along) const;
};

/// Of the light behind: the share that comes through; of the fog's own: the share that is seen.
struct FogShares {
    double transmittance = 1, opacity = 0;
};

/// The integral of density: Gauss and Kronrod's rule of 15 points, in pieces that are halved until it agrees with
/// Gauss' of 7; then Beer and Lambert's law, and what does not come through is the fog's.
FogShares fog_by_thickness(const FogPath& path);

/// The equation of light on its way itself, from the eye on: Runge and Kutta's rule of fourth order, its steps halved
/// and extrapolated, in both shares. Stops where nothing comes through.
FogShares fog_by_transfer(const FogPath& path);

} // namespace postfx::host
