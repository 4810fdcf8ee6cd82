#include <image/orientation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace postfx {
namespace {

/// What is done to the stored picture, in this order.
struct Steps {
    bool transpose, mirror_x,
        mirror_y; ///< about the diagonal from the top left; left to right; top to bottom
};

constexpr Steps steps_of(int orientation) {
    constexpr std::array<Steps, 9> steps = {{{false, false, false},
                                             {false, false, false},
                                             {false, true, false},
                                             {false, true, true},
                                             {false, false, true},
                                             {true, false, false},
                                             {true, true, false},
                                             {true, true, true},
                                             {true, false, true}}};
    return steps[static_cast<std::size_t>(orientation >= 1 && orientation <= 8 ? orientation : 1)];
}

} // namespace

Image oriented(const Image& stored, int orientation) {
    const Steps steps = steps_of(orientation);
    const int width = steps.transpose ? stored.height : stored.width;
    const int height = steps.transpose ? stored.width : stored.height;
    Image image(width, height, stored.channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // Counted from the top left, as the tag does.
            int from_x = steps.mirror_x ? width - 1 - x : x;
            int from_y = steps.mirror_y ? y : height - 1 - y;
            if (steps.transpose) std::swap(from_x, from_y);
            std::copy_n(stored.pixel(from_x, stored.height - 1 - from_y), stored.channels, image.pixel(x, y));
        }
    return image;
}

Image oriented_normals(const Image& stored, int orientation, VectorCoding coding) {
    Image image = oriented(stored, orientation);
    if (image.channels < 3) return image;
    const Steps steps = steps_of(orientation);
    const auto negated = [&](float value) { return coding == VectorCoding::halves ? 1 - value : -value; };
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        float* vector = &image.values[i * static_cast<std::size_t>(image.channels)];
        // The diagonal exchanges right and down, so x and -y.
        if (steps.transpose) vector[0] = negated(std::exchange(vector[1], negated(vector[0])));
        if (steps.mirror_x) vector[0] = negated(vector[0]);
        if (steps.mirror_y) vector[1] = negated(vector[1]);
    }
    return image;
}

Belonging belonging_of(const Image& map, int width, int height, int orientation) {
    if (!exchanges_sides(orientation) || width == height) return Belonging::unknown;
    if (map.width == width && map.height == height) return Belonging::turned;
    if (map.width == height && map.height == width) return Belonging::stored;
    // Depth of fewer pixels has the shape of one of both, but for the whole pixels that its sides are rounded to.
    const auto has_shape_of = [&](double across, double up) {
        return std::abs(map.width * up / across - map.height) < 1
               || std::abs(map.height * across / up - map.width) < 1;
    };
    if (has_shape_of(width, height)) return Belonging::turned;
    return has_shape_of(height, width) ? Belonging::stored : Belonging::unknown;
}

} // namespace postfx
