#include "quadrature.hpp"

#include <cmath>
#include <numbers>

namespace postfx::host {

std::vector<QuadratureNode> gauss_legendre(int count) {
    std::vector<QuadratureNode> nodes;
    for (int i = 0; i < count; ++i) {
        // Roots of the Legendre polynomial by Newton's method, from a guess that is good to 1 / count^2.
        double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
        for (int step = 0; step < 8; ++step) {
            double before = 1, value = x;
            for (int n = 2; n <= count; ++n) {
                const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
                before = value;
                value = next;
            }
            slope = count * (x * value - before) / (x * x - 1);
            x -= value / slope;
        }
        nodes.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
    }
    return nodes;
}

} // namespace postfx::host
