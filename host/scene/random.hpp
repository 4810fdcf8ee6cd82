// Reproducible pseudo-random numbers and lattice noise: the same on every machine and compiler.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace postfx::host {

/// PCG32 (O'Neill 2014). The standard library's distributions differ between implementations, this does not.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x853c49e6748fea9bu) { next(); }

    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005u + 1442695040888963407u;
        const auto mixed = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto turn = static_cast<std::uint32_t>(old >> 59u);
        return (mixed >> turn) | (mixed << ((32u - turn) & 31u));
    }
    /// In [0, 1).
    float unit() { return static_cast<float>(next() >> 8u) * (1.0f / 16777216.0f); }
    float between(float low, float high) { return low + (high - low) * unit(); }
    float between(glm::vec2 range) { return between(range.x, range.y); }

private:
    std::uint64_t state_;
};

/// Smooth value noise in -1..1 with a lattice of 1; twice differentiable (quintic weights, Perlin 2002).
inline double lattice_noise(double x, double y, std::uint32_t seed) {
    const auto corner = [&](double i, double j) {
        auto h = static_cast<std::uint32_t>(static_cast<std::int64_t>(i)) * 0x8da6b343u
                 ^ static_cast<std::uint32_t>(static_cast<std::int64_t>(j)) * 0xd8163841u
                 ^ seed * 0xcb1ab31fu;
        h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
        h = (h ^ (h >> 12u)) * 0x297a2d39u;
        return static_cast<double>((h ^ (h >> 15u)) >> 8u) * (2.0 / 16777216.0) - 1.0;
    };
    const double i = std::floor(x), j = std::floor(y);
    const auto ease = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double u = ease(x - i), v = ease(y - j);
    return glm::mix(glm::mix(corner(i, j), corner(i + 1, j), u),
                    glm::mix(corner(i, j + 1), corner(i + 1, j + 1), u), v);
}

} // namespace postfx::host
