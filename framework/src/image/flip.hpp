// LDR-FLIP: how much of a difference a viewer sees who flips between two pictures.
//
// P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques
// 3(2), 2020.
#pragma once

#include <postfx/image.hpp>

#include <cstddef>
#include <numbers>

namespace postfx {

/// Pixels per degree of the visual field for a viewer `distance` metres from a screen `width` metres and
/// `columns` pixels wide.
constexpr double pixels_per_degree(double distance, double width, double columns) {
    return distance * columns / width * std::numbers::pi / 180;
}

/// The paper's viewing condition: 0.7 m from a 3840 pixels and 0.7 m wide screen; 67.02.
constexpr double default_pixels_per_degree = pixels_per_degree(0.7, 0.7, 3840);

enum class Encoding { linear, srgb };

struct FlipError {
    /// One channel, 0 (no difference seen) to 1; infinity where one of the pictures isn't finite.
    Image map;
    /// Of the map. All of them are infinity if non_finite > 0.
    double mean = 0, min = 0, max = 0;
    /// Values below which the errors make up a quarter, half and three quarters of the sum of all errors, so
    /// that pixels without an error don't count; 0 if no pixel has one.
    double weighted_first_quartile = 0, weighted_median = 0, weighted_third_quartile = 0;
    std::size_t non_finite = 0; ///< pixels that aren't finite in one picture or both; never skipped silently
    std::size_t clipped = 0;    ///< pixels outside [0, 1] in one picture or both: shown as 0 or 1
};

/// Display-referred pictures of 1 (grey) to 4 channels (alpha is left out), in [0, 1]: a display shows no
/// more, so light must be tone mapped first. `encoding` says what both hold: linear light or sRGB codes / 255.
/// Symmetric in the pictures. float64 in one order on one thread: same pictures, same bits. Error: different
/// sizes, empty, or `pixels_per_degree` outside [1, 1000].
FlipError flip(const Image& reference, const Image& test, Encoding encoding,
               double pixels_per_degree = default_pixels_per_degree);

} // namespace postfx
