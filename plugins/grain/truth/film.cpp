#include "film.hpp"

#include <truths/quadrature.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace postfx::host {
namespace {

constexpr double pi = std::numbers::pi;

/// Density of the distance of two points in a square of side 1.
double distance_density(double r) {
    if (r <= 1) return 2 * r * (r * r - 4 * r + pi);
    const double s = std::sqrt(r * r - 1);
    return 2 * r * (4 * s - (r * r + 2 - pi) - 4 * std::atan(s));
}

/// A bijection of 64 bits in which all bits depend on all (Steele, Lea, Flood 2014, "SplitMix").
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30u)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27u)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31u);
}

/// Bits from `first` on, as a number in 0..1 that is neither.
double fraction(std::uint64_t bits, unsigned first, unsigned count) {
    const auto number = static_cast<double>((bits >> first) & ((std::uint64_t(1) << count) - 1));
    return (number + 0.5) / static_cast<double>(std::uint64_t(1) << count);
}

} // namespace

double grainy_light(double light) {
    return std::clamp(light, least_grainy_light, 1 - least_grainy_light);
}

double FilmStatistics::point_covariance(double u, double distance) const {
    const double q = distance / diameter_;
    if (q >= 1) return 0;
    const double common = 2 / pi * (std::acos(q) - q * std::sqrt(1 - q * q)); // of two discs, as a share
    // Neither is covered with the probability e^(-intensity (2 - common) area), and e^(-intensity area) = 1 - u.
    return std::pow(1 - u, 2 - common) - (1 - u) * (1 - u);
}

double FilmStatistics::pixel_variance(double u) const {
    static const std::vector<QuadratureNode> nodes = gauss_legendre(48);
    double sum = 0;
    const auto add = [&](double from, double to) {
        to = std::min(to, diameter_);
        if (to <= from) return;
        for (const QuadratureNode& node : nodes) {
            const double r = from + (to - from) * node.place;
            sum += (to - from) * node.weight * distance_density(r) * point_covariance(u, r);
        }
    };
    add(0, 1);
    add(1, std::numbers::sqrt2);
    return sum;
}

double FilmStatistics::pixel_covariance(double u, int across, int up) const {
    if (across == 0 && up == 0) return pixel_variance(u);
    // The difference of two places in the unit square has the density (1 - |x|)(1 - |y|).
    static const std::vector<QuadratureNode> nodes = gauss_legendre(24);
    double sum = 0;
    for (const QuadratureNode& x : nodes) {
        for (const QuadratureNode& y : nodes) {
            const double weight = x.weight * y.weight * (1 - x.place) * (1 - y.place);
            for (const double i : {x.place, -x.place}) {
                for (const double j : {y.place, -y.place})
                    sum += weight * point_covariance(u, std::hypot(across + i, up + j));
            }
        }
    }
    return sum;
}

int FilmStatistics::reach() const {
    return static_cast<int>(std::ceil(diameter_)) + 1;
}

double Film::bareness(double light) {
    // A disc is pi / 4 of its cell.
    return std::pow(1 - grainy_light(light), 4 / pi);
}

bool Film::is_covered(int layer, double x, double y, double bareness) const {
    const double u = x / diameter_, v = y / diameter_; // cells of side 1, discs of diameter 1
    const auto first_i = static_cast<std::int64_t>(std::floor(u - 0.5));
    const auto first_j = static_cast<std::int64_t>(std::floor(v - 0.5));
    const std::uint64_t layer_key = mixed(key_ + static_cast<std::uint64_t>(layer) * 0x9e3779b97f4a7c15u);
    for (std::int64_t j = first_j; j <= first_j + 1; ++j) {
        for (std::int64_t i = first_i; i <= first_i + 1; ++i) {
            std::uint64_t state = mixed(layer_key + static_cast<std::uint64_t>(i) * 0xc2b2ae3d27d4eb4fu
                                        + static_cast<std::uint64_t>(j) * 0x165667b19e3779f9u);
            // Discs arrive one by one as the light grows, with exponential gaps -ln(number): there are those for
            // which the product of numbers is still above the probability of none (Knuth's way to a Poisson variate).
            double product = 1;
            for (;;) {
                state += 0x9e3779b97f4a7c15u;
                const std::uint64_t bits = mixed(state);
                product *= fraction(bits, 0, 24);
                if (product <= bareness) break;
                const double away_x = static_cast<double>(i) + fraction(bits, 24, 20) - u;
                const double away_y = static_cast<double>(j) + fraction(bits, 44, 20) - v;
                if (away_x * away_x + away_y * away_y < 0.25) return true;
            }
        }
    }
    return false;
}

} // namespace postfx::host
