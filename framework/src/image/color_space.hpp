// Linear colour spaces by their primaries and white, and how they become Rec. 709.
#pragma once

#include <postfx/image.hpp>

#include <array>
#include <optional>

namespace postfx {

/// White of another colour space stays what it is (none: light keeps its XYZ), or becomes the white of Rec. 709
/// (bradford: R = G = B stays so).
enum class Adaptation { none, bradford };

/// CIE 1931 x and y.
struct Chromaticity {
    double x = 0, y = 0;
};

/// Of R, G and B alone, and of R = G = B = 1, whose luminance Y is 1.
struct Chromaticities {
    Chromaticity red, green, blue, white;
};

/// ITU-R BT.709, white D65.
inline constexpr Chromaticities rec709_chromaticities = {
    {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/// All eight numbers within 1e-4, as files round them.
bool is_rec709(const Chromaticities& space);

/// Row by row: out[i] = sum over j of matrix[3 * i + j] * in[j].
using ColorMatrix = std::array<double, 9>;

ColorMatrix product(const ColorMatrix& left, const ColorMatrix& right);
/// Nothing if it has none.
std::optional<ColorMatrix> inverse(const ColorMatrix& matrix);

/// Linear RGB to XYZ with Y = 1 for white. Nothing if the numbers make no colour space: one isn't finite or is absurd,
/// the primaries lie on a line, or white is outside of them.
std::optional<ColorMatrix> matrix_to_xyz(const Chromaticities& space);

/// Linear RGB to linear Rec. 709; nothing as for matrix_to_xyz.
std::optional<ColorMatrix> matrix_to_rec709(const Chromaticities& space, Adaptation adaptation);

/// Change the first three channels of each pixel; sums are made in double. `image`: 3 or 4 channels.
void convert_colors(Image& image, const ColorMatrix& matrix);

} // namespace postfx
