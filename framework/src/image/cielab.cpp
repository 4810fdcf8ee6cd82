#include <image/cielab.hpp>

#include <cmath>
#include <cstddef>

namespace postfx {
namespace {

using Matrix = std::array<Triple, 3>; ///< rows

/// The sRGB primaries and D65 as fractions: the ones that the published numbers of FLIP were made with. Other
/// tables round the white differently, by 3e-5.
constexpr Matrix rgb_to_xyz = {{
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
}};

Triple product(const Matrix& matrix, const Triple& v) {
    Triple result{};
    for (std::size_t row = 0; row < 3; ++row)
        result[row] = matrix[row][0] * v[0] + matrix[row][1] * v[1] + matrix[row][2] * v[2];
    return result;
}

/// By cofactors: an inverse to the last bits, so that a colour that goes there and back stays.
Matrix inverse(const Matrix& m) {
    const auto cofactor = [&](std::size_t row, std::size_t column) {
        const std::size_t r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3,
                          c2 = (column + 2) % 3;
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    };
    const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    Matrix result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            result[row][column] = cofactor(column, row) / determinant;
    return result;
}

/// The cube root, with a straight line near 0 (slope and value meet at `knee` cubed).
constexpr double knee = 6.0 / 29;
double compressed(double t) {
    return t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
}
double expanded(double f) {
    return f > knee ? f * f * f : 3 * knee * knee * (f - 4.0 / 29);
}

} // namespace

Triple linear_to_xyz(const Triple& linear) {
    return product(rgb_to_xyz, linear);
}

Triple xyz_to_linear(const Triple& xyz) {
    static const Matrix matrix = inverse(rgb_to_xyz);
    return product(matrix, xyz);
}

const Triple& white_xyz() {
    static const Triple white = linear_to_xyz({1, 1, 1});
    return white;
}

Triple xyz_to_lab(const Triple& xyz) {
    const Triple& white = white_xyz();
    const double x = compressed(xyz[0] / white[0]), y = compressed(xyz[1] / white[1]),
                 z = compressed(xyz[2] / white[2]);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Triple lab_to_xyz(const Triple& lab) {
    const Triple& white = white_xyz();
    const double y = (lab[0] + 16) / 116;
    return {white[0] * expanded(y + lab[1] / 500), white[1] * expanded(y),
            white[2] * expanded(y - lab[2] / 200)};
}

} // namespace postfx
