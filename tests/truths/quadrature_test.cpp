// Integrals that are known exactly.
#include <catch2/catch.hpp>

#include <truths/quadrature.hpp>

#include <cmath>

using namespace postfx::host;

TEST_CASE("Gauss nodes integrate polynomials exactly") {
    for (const int count : {1, 2, 7, 32, 64}) {
        for (int power = 0; power < 2 * count; power += 3) {
            double sum = 0;
            for (const QuadratureNode& node : gauss_legendre(count))
                sum += node.weight * std::pow(node.place, power);
            CHECK(sum == Approx(1.0 / (power + 1)).epsilon(1e-13)); // rounding
        }
    }
}
