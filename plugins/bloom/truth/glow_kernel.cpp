#include "glow_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace postfx::host {

GlowKernel::GlowKernel(double deviation, int nodes)
    : rate_(5 * deviation * deviation), nodes_(gauss_legendre(nodes)) {}

double GlowKernel::share_left(double loss) const {
    constexpr double vanishes = 40; // e^-40 is below what float64 holds beside 1
    const double rate = rate_ * loss;
    const double reach = rate > vanishes ? std::pow(vanishes / rate, 0.25) : 1;
    double sum = 0;
    for (const QuadratureNode& node : nodes_)
        sum += node.weight * std::exp(-rate * std::pow(reach * node.place, 4));
    return reach * sum;
}

std::vector<double> shares_left(const GlowKernel& kernel, int width, int height) {
    std::vector<double> shares;
    shares.reserve(static_cast<std::size_t>(width) * height);
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
            shares.push_back(kernel.share_left(2 - std::cos(std::numbers::pi * i / width)
                                               - std::cos(std::numbers::pi * j / height)));
        }
    }
    return shares;
}

} // namespace postfx::host
