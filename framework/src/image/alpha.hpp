// Colour that is multiplied by its alpha (as OpenEXR has it) and colour that is not (as PNG has it).
#pragma once

#include <image/files.hpp>

namespace postfx {

/// Colour with the other kind of alpha, in linear light. Nothing is divided by an alpha of 0: light without cover (a
/// flame in an EXR) stays as it is. Images without alpha (1 or 3 channels), and from or to Coding::Alpha::none, come
/// back unchanged.
Image with_alpha(Image image, Coding::Alpha from, Coding::Alpha to);

} // namespace postfx
