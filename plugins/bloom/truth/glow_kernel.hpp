// The kernel by which light is scattered around bright places, exactly.
#pragma once

#include <truths/quadrature.hpp>

#include <postfx/image.hpp>

#include <vector>

namespace postfx::host {

/// A sum of Gaussians of every width: sqrt(sigma) is evenly distributed from 0 to its largest value, so that the
/// variance is v(t) = 5 d^2 t^4 for t evenly spread over 0..1, with the mean d^2. Among pixels, a Gaussian is the one
/// that has its variance exactly: e^(-v (1 - cos w)) on each axis, for waves of w radians per pixel (Lindeberg 1990).
class GlowKernel {
public:
    /// `deviation` d on each axis [px]; `nodes` of the integral over t. 32 are exact to 1e-12.
    GlowKernel(double deviation, int nodes);

    /// What is left of waves for which (1 - cos) of both axes sum to `loss`, 0 to 4.
    double share_left(double loss) const;

private:
    double rate_; ///< of t^4, per loss
    std::vector<QuadratureNode> nodes_;
};

/// shares_left()[i + j width]: of wave (i, j) of a picture that goes on as its mirror image, as cosine_waves()
/// counts.
std::vector<double> shares_left(const GlowKernel& kernel, int width, int height);

} // namespace postfx::host
