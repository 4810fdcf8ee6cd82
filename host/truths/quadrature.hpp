// Integrals of smooth functions.
#pragma once

#include <vector>

namespace postfx::host {

struct QuadratureNode {
    double place, weight;
};

/// Gauss and Legendre's nodes for integrals over 0..1: exact for polynomials up to the degree 2 count - 1. Weights
/// sum to 1.
std::vector<QuadratureNode> gauss_legendre(int count);

} // namespace postfx::host
