// A picture between its pixels.
#pragma once

#include <postfx/image.hpp>

namespace postfx::host {

/// The spline of degree 5 through all pixels (B-spline interpolation: Unser 1999, "Splines: a perfect fit for signal
/// and image processing"). Polynomials up to that degree are exact, and so is the light of whatever lies inside; a
/// wave of 6 pixels is right to 5e-4. Edges of a pixel's width ring. Outside of the picture its edge goes on.
class SplinePicture {
public:
    /// 3 channels.
    explicit SplinePicture(Image64 picture);

    /// x and y in pixels from the lower left corner.
    double at(double x, double y, int channel) const;
    /// The same held to the range of the 4x4 pixels around the place: no dark rings around lamps. Of pictures of
    /// scenes that are known between their pixels, this gives the best ones displaced (against them, the spline
    /// itself is off by up to a fifth more, linear interpolation by a half more).
    double within_neighbours(double x, double y, int channel) const;

private:
    Image64 picture_;
    Image64 coefficients_; ///< with a margin around it
};

} // namespace postfx::host
