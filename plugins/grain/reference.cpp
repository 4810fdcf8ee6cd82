// The grain's model in float64. The hash is part of the model (Jarzynski and Olano 2020, "pcg3d") and is
// written down here a second time.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace postfx::testing {
namespace {

using Triple = std::array<double, 3>;

Triple random_at(int x, int y, const ReferenceInput& input) {
    const std::uint32_t grain_stream = 0x6a11e;
    std::uint32_t v[3] = {static_cast<std::uint32_t>(x + 65536 * y), input.frame,
                          input.seed * 2654435769u + grain_stream};
    for (std::uint32_t& word : v)
        word = word * 1664525u + 1013904223u;
    for (int round = 0; round < 2; ++round) {
        for (int i = 0; i < 3; ++i)
            v[i] += v[(i + 1) % 3] * v[(i + 2) % 3];
        if (round == 0) {
            for (std::uint32_t& word : v)
                word ^= word >> 16;
        }
    }
    Triple result;
    for (int i = 0; i < 3; ++i)
        result[i] = std::sqrt(12.0) * ((v[i] >> 8) / 16777216.0 - 0.5);
    return result;
}

/// Corner (i, j) of the triangular lattice with edges of length `edge` stands at i * a + j * b, where a and b
/// are the edges that lie symmetrically about the diagonal.
Triple clumps_at(double x, double y, double edge, const ReferenceInput& input) {
    const double pi = std::acos(-1.0);
    const double ax = edge * std::cos(pi / 12), ay = -edge * std::sin(pi / 12);
    const double bx = -edge * std::sin(pi / 12), by = edge * std::cos(pi / 12);
    const double reach = edge * std::sqrt(3.0) / 2; // height of a triangle
    const double determinant = ax * by - ay * bx;
    const auto i0 = static_cast<int>(std::floor((x * by - y * bx) / determinant));
    const auto j0 = static_cast<int>(std::floor((y * ax - x * ay) / determinant));
    Triple sum{};
    double squares = 0;
    for (int j = j0 - 1; j <= j0 + 2; ++j) {
        for (int i = i0 - 1; i <= i0 + 2; ++i) {
            const double dx = x - (i * ax + j * bx), dy = y - (i * ay + j * by);
            const double inside = 1 - (dx * dx + dy * dy) / (reach * reach);
            if (inside <= 0) continue;
            const double weight = inside * inside;
            const Triple value = random_at(i, j, input);
            for (int c = 0; c < 3; ++c)
                sum[c] += weight * value[c];
            squares += weight * weight;
        }
    }
    for (double& value : sum)
        value /= std::sqrt(squares);
    return sum;
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const int width = input.color.width, height = input.color.height;
    const double size = input.value("size") * height;
    const double amount = input.value("amount") * (size < 1 ? size : 1);
    const double own = std::sqrt(input.value("color"));
    const double joint = (std::sqrt(3 - 2 * input.value("color")) - own) / 3;
    Image64 result(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Triple field = size > 1 ? clumps_at(x + 0.5, y + 0.5, size, input) : random_at(x, y, input);
            const double all = field[0] + field[1] + field[2];
            for (int c = 0; c < 3; ++c) {
                const double u = input.color.at(x, y, c);
                const double room = std::max(0.0, std::min(u, 1 - u));
                const double noise =
                    amount * std::sqrt(std::max(0.0, u * (1 - u))) * (own * field[c] + joint * all);
                result.at(x, y, c) = u + std::clamp(noise, -room, room);
            }
        }
    }
    return result;
}

} // namespace postfx::testing
