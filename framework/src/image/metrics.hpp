// How different two pictures are.
#pragma once

#include <postfx/image.hpp>

#include <cstddef>

namespace postfx {

struct Difference {
    double max_abs = 0;          ///< largest |a - b| over finite values
    double rmse = 0;             ///< root mean square over all channels
    double psnr = 0;             ///< 20 log10(peak / rmse) [dB]; infinity when equal
    double ssim = 1;             ///< mean structural similarity of luma, 11x11 Gaussian sigma 1.5 (Wang et al. 2004)
    std::size_t differing = 0;   ///< pixels with any channel that differs in bits (-0 and 0, NaN payloads included)
    std::size_t non_finite = 0;  ///< pixels where one is finite and the other is not; never skipped silently
    int worst_x = 0, worst_y = 0;
};

/// Same size and channel count, else Error. `peak`: the value that PSNR and SSIM call full scale.
Difference compare(const Image& a, const Image& b, double peak = 1.0);

} // namespace postfx
