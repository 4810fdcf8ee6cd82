// Whether a sample of a file is the number that somebody wrote down.
#pragma once

#include <image/files.hpp>

namespace postfx {

/// Is `sample` what the file has for `wanted`? Both are rounded as the file's samples are: 1e30 is infinity in half,
/// 999.9 the nearest float, and 0.5 the nearest of the codes, which are read as 0..1. NaN is NaN.
bool matches_sample(double wanted, float sample, const Coding& coding);

} // namespace postfx
