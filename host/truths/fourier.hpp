// Transforms of whole pictures, in float64.
#pragma once

#include <vector>

namespace postfx::host {

/// Cosine waves (DCT-II) of `width` x `height` values in rows: number (i, j) goes with
/// cos(pi i (x + 1/2) / width) cos(pi j (y + 1/2) / height). A picture that goes on as its mirror image consists of
/// these and nothing else.
std::vector<double> cosine_waves(std::vector<double> values, int width, int height);
/// Back again.
std::vector<double> sum_of_waves(std::vector<double> waves, int width, int height);

/// Squared magnitudes of the Fourier transform over the number of values: their mean is the values' mean square.
/// (i, j) goes with i / width and j / height waves per pixel, i from 0 to width / 2, width / 2 + 1 numbers a row.
std::vector<double> periodogram(std::vector<double> values, int width, int height);

} // namespace postfx::host
