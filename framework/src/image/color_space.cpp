#include <image/color_space.hpp>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

using Vector = std::array<double, 3>;

Vector times(const ColorMatrix& matrix, const Vector& vector) {
    Vector result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            result[row] += matrix[3 * row + column] * vector[column];
    return result;
}

ColorMatrix diagonal(const Vector& values) {
    return {values[0], 0, 0, 0, values[1], 0, 0, 0, values[2]};
}

/// X, Y and Z of a light with X + Y + Z = 1.
Vector direction_of(const Chromaticity& color) {
    return {color.x, color.y, 1 - color.x - color.y};
}

/// XYZ with Y = 1.
Vector white_of(const Chromaticities& space) {
    Vector white = direction_of(space.white);
    for (double& value : white)
        value /= space.white.y;
    return white;
}

/// Primaries of wide spaces lie outside of the spectral locus (ACES AP0: y = -0.077), none far from it.
bool is_plausible(const Chromaticity& color) {
    constexpr double farthest = 4;
    return std::abs(color.x) <= farthest && std::abs(color.y) <= farthest;
}

/// K. M. Lam's cone responses of 1985 ("Bradford"), as ICC.1:2022, annex E, has them.
constexpr ColorMatrix bradford = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};

/// XYZ under `from` to XYZ under `to`.
ColorMatrix adaptation_matrix(const Vector& from, const Vector& to) {
    const Vector seen = times(bradford, from), wanted = times(bradford, to);
    const ColorMatrix scale = diagonal({wanted[0] / seen[0], wanted[1] / seen[1], wanted[2] / seen[2]});
    return product(*inverse(bradford), product(scale, bradford));
}

} // namespace

bool is_rec709(const Chromaticities& space) {
    constexpr double rounding = 1e-4;
    const auto same = [](const Chromaticity& a, const Chromaticity& b) {
        return std::abs(a.x - b.x) <= rounding && std::abs(a.y - b.y) <= rounding;
    };
    const Chromaticities& own = rec709_chromaticities;
    return same(space.red, own.red) && same(space.green, own.green) && same(space.blue, own.blue)
           && same(space.white, own.white);
}

ColorMatrix product(const ColorMatrix& left, const ColorMatrix& right) {
    ColorMatrix result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            for (std::size_t i = 0; i < 3; ++i)
                result[3 * row + column] += left[3 * row + i] * right[3 * i + column];
    return result;
}

std::optional<ColorMatrix> inverse(const ColorMatrix& matrix) {
    const auto cofactor = [&](std::size_t row, std::size_t column) {
        const auto at = [&](std::size_t down, std::size_t right) {
            return matrix[3 * ((row + down) % 3) + (column + right) % 3];
        };
        return at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
    };
    double determinant = 0;
    for (std::size_t column = 0; column < 3; ++column)
        determinant += matrix[column] * cofactor(0, column);
    double largest = 0;
    for (const double value : matrix)
        largest = std::max(largest, std::abs(value));
    // Nine digits of a double are left to the inverse.
    if (!(std::abs(determinant) > 1e-7 * largest * largest * largest)) return std::nullopt;
    ColorMatrix result;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            result[3 * column + row] = cofactor(row, column) / determinant;
    return result;
}

std::optional<ColorMatrix> matrix_to_xyz(const Chromaticities& space) {
    for (const Chromaticity& color : {space.red, space.green, space.blue, space.white})
        if (!is_plausible(color)) return std::nullopt;
    if (!(space.white.y > 1e-3)) return std::nullopt;
    const Vector red = direction_of(space.red), green = direction_of(space.green),
                 blue = direction_of(space.blue);
    const ColorMatrix directions = {red[0],  green[0], blue[0],  red[1], green[1],
                                    blue[1], red[2],   green[2], blue[2]};
    const std::optional<ColorMatrix> shares = inverse(directions);
    if (!shares) return std::nullopt;
    // How much of each primary makes white; no division by a primary's y, which may be 0 (X and Z themselves).
    const Vector amounts = times(*shares, white_of(space));
    if (!(*std::min_element(amounts.begin(), amounts.end()) > 0)) return std::nullopt;
    return product(directions, diagonal(amounts));
}

std::optional<ColorMatrix> matrix_to_rec709(const Chromaticities& space, Adaptation adaptation) {
    const std::optional<ColorMatrix> to_xyz = matrix_to_xyz(space);
    if (!to_xyz) return std::nullopt;
    const ColorMatrix from_xyz = *inverse(*matrix_to_xyz(rec709_chromaticities));
    if (adaptation == Adaptation::none) return product(from_xyz, *to_xyz);
    const ColorMatrix adapted = adaptation_matrix(white_of(space), white_of(rec709_chromaticities));
    return product(from_xyz, product(adapted, *to_xyz));
}

void convert_colors(Image& image, const ColorMatrix& matrix) {
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        float* values = &image.values[pixel * static_cast<std::size_t>(image.channels)];
        const Vector changed = times(matrix, {values[0], values[1], values[2]});
        std::transform(changed.begin(), changed.end(), values,
                       [](double value) { return static_cast<float>(value); });
    }
}

} // namespace postfx
