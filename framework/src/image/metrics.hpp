// How different two pictures are.
#pragma once

#include <postfx/image.hpp>

#include <cstddef>

namespace postfx {

struct Difference {
    double max_abs = 0; ///< largest |a - b| where both are finite
    double rmse = 0;    ///< root mean square over all channels; infinity if any pixel counts as non_finite
    double psnr = 0;    ///< 20 log10(peak / rmse) [dB]; infinity when equal, -infinity if non_finite > 0
    /// Mean structural similarity of luma, 11x11 Gaussian of sigma 1.5 (Wang et al. 2004), the window that
    /// fits for smaller pictures; 0 if non_finite > 0.
    double ssim = 1;
    /// Pixels with any channel that differs in bits (-0 and 0, NaN payloads included).
    std::size_t differing = 0;
    /// Pixels with a NaN or infinity that the other does not have; never skipped silently.
    std::size_t non_finite = 0;
    /// Where max_abs is; the first pixel of non_finite if there is one.
    int worst_x = 0, worst_y = 0;
};

/// Same size and channel count, else Error. `peak`: the value that PSNR and SSIM call full scale.
Difference compare(const Image& a, const Image& b, double peak = 1.0);

/// How far a picture of linear light is from its reference, in proportion to the light; over the colours,
/// alpha is left out. Both are infinity if non_finite > 0.
struct RelativeError {
    /// Mean of (x - r)^2 / (|r| + 0.01)^2: every pixel in proportion to itself, so shadows weigh as lights do.
    double rel_mse = 0;
    /// sqrt(sum (x - r)^2 / sum r^2): all pixels in proportion to the whole picture, so lights weigh most.
    /// Infinity for a difference from a black reference.
    double relative_rmse = 0;
    /// Pixels with a NaN or infinity in either picture, in both too: light that isn't finite has no error.
    std::size_t non_finite = 0;
};

/// Same size and channel count, else Error. Not symmetric.
RelativeError relative_error(const Image64& picture, const Image64& reference);

} // namespace postfx
