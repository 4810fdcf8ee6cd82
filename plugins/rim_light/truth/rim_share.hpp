// The share of a rim's light by the angle at which a surface is seen.
#pragma once

#include <algorithm>
#include <cmath>

namespace postfx::host {

struct RimShare {
    bool mirrors = false; ///< profile fresnel; else the ramp
    double width = 0.25, refractive_index = 1.5;

    /// `cosine` of the angle between the surface's normal and the direction to the eye; its sign does not matter.
    template<class Number>
    Number at(Number cosine) const {
        const Number c = std::min(std::abs(cosine), Number(1));
        if (!mirrors) return c < Number(width) ? (Number(width) - c) / Number(width) : Number(0);
        // What is mirrored of either polarisation, by the angle behind the surface too (Snell's law).
        const Number n = Number(refractive_index);
        const Number inside = std::sqrt(1 - (1 - c * c) / (n * n));
        const Number across = (c - n * inside) / (c + n * inside),
                     along = (inside - n * c) / (inside + n * c);
        return (across * across + along * along) / 2;
    }
};

} // namespace postfx::host
