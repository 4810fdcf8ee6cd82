// The eight ways in which a camera may have been held (EXIF tag 0x0112), as pure functions of pixels.
#pragma once

#include <postfx/image.hpp>

namespace postfx {

/// Of a normal map's first two channels: vectors as they are, or as 0.5 + v / 2.
enum class VectorCoding { as_they_are, halves };

/// Does orientation 1 to 8 exchange width and height?
constexpr bool exchanges_sides(int orientation) {
    return orientation >= 5;
}

/// The picture as the camera saw it. `orientation`: what row 0 and column 0 of the stored picture (counted from its
/// top left) are, 1 to 8; 6: a phone held upright, to be turned a quarter clockwise.
Image oriented(const Image& stored, int orientation);

/// A normal map of view space (x to the right, y up): its pixels are moved, and the vectors turn with them.
Image oriented_normals(const Image& stored, int orientation, VectorCoding coding);

/// Does a map belong to a photograph as it was stored, before it was turned?
enum class Belonging {
    turned,  ///< it has the size, or else the shape, that the photograph has now
    stored,  ///< it has those that the photograph had before: it must be turned as well
    unknown, ///< both are the same, or it has neither
};

/// `width`, `height`: of the photograph after turning by `orientation`.
Belonging belonging_of(const Image& map, int width, int height, int orientation);

} // namespace postfx
