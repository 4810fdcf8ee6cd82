// Colours for pictures of errors.
#pragma once

#include <postfx/image.hpp>

#include <cstdint>
#include <vector>

namespace postfx {

/// 8-bit sRGB codes, 3 per pixel, for the first channel of `errors`: black at 0 over violet, red and orange
/// to almost white at 1, L* growing in proportion, so that it reads the same printed in grey. Outside [0, 1]
/// as at the nearer end; what is not finite becomes pure green, which no error has.
std::vector<std::uint8_t> heat_colors(const Image& errors);

} // namespace postfx
