// Where truths sample: points in the square that fill it evenly, in two independent halves.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace postfx::host {

/// A good mixer of 32 bits (Wellons, "prospecting for hash functions").
inline std::uint32_t mix_bits(std::uint32_t x) {
    x = (x ^ (x >> 16u)) * 0x21f0aaadu;
    x = (x ^ (x >> 15u)) * 0xd35a2d97u;
    return x ^ (x >> 15u);
}

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16u) | (x >> 16u);
    x = ((x & 0x00ff00ffu) << 8u) | ((x & 0xff00ff00u) >> 8u);
    x = ((x & 0x0f0f0f0fu) << 4u) | ((x & 0xf0f0f0f0u) >> 4u);
    x = ((x & 0x33333333u) << 2u) | ((x & 0xccccccccu) >> 2u);
    return ((x & 0x55555555u) << 1u) | ((x & 0xaaaaaaaau) >> 1u);
}

/// Owen's scrambling by a hash in which each bit depends only on those above (Burley 2020, "Practical hash-based Owen
/// scrambling", with the constants of Laine and Karras 2011).
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverse_bits(x);
}

/// Point `index` of Sobol's sequence in [0, 1)^2, scrambled by the seed: any first 2^k points are evenly spread, and
/// two seeds give two independent estimates.
inline glm::dvec2 sobol_point(std::uint32_t index, std::uint32_t seed) {
    std::uint32_t y = 0;
    for (std::uint32_t bits = index, direction = 1u << 31u; bits != 0;
         bits >>= 1u, direction ^= direction >> 1u) {
        if (bits & 1u) y ^= direction;
    }
    constexpr double unit = 1.0 / 4294967296.0;
    return {unit * owen_scramble(reverse_bits(index), mix_bits(seed)),
            unit * owen_scramble(y, mix_bits(seed ^ 0x9e3779b9u))};
}

/// Sample `index` of a truth: even ones and odd ones are a sequence each.
inline glm::dvec2 truth_point(int index, std::uint32_t seed) {
    const auto number = static_cast<std::uint32_t>(index);
    return sobol_point(number / 2, mix_bits(2 * seed + number % 2 + 1));
}

/// From the square to the unit disc, keeping areas (Shirley and Chiu 1997).
inline glm::dvec2 disc_point(glm::dvec2 square) {
    const glm::dvec2 p = 2.0 * square - 1.0;
    if (p.x == 0 && p.y == 0) return p;
    constexpr double quarter = std::numbers::pi / 4;
    const bool wide = std::abs(p.x) > std::abs(p.y);
    const double radius = wide ? p.x : p.y;
    const double angle = wide ? quarter * (p.y / p.x) : quarter * (2 - p.x / p.y);
    return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

} // namespace postfx::host
