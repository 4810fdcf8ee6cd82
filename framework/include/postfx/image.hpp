// Pixels on the CPU.
#pragma once

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace postfx {

/// A picture of interleaved channels. Row 0 is the BOTTOM row (as OpenGL counts), column 0 the left one; file
/// readers and writers turn the rows of top-down formats round. Values are whatever the picture means:
/// scene-linear light, depth, normals; nothing is clamped.
template<class Number>
struct BasicImage {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<Number> values; ///< width * height * channels, rows without padding

    BasicImage() = default;
    BasicImage(int width, int height, int channels, Number value = Number(0))
        : width(width), height(height), channels(channels),
          values(static_cast<std::size_t>(width) * height * channels, value) {}
    /// Of values that are there already: width * height * channels of them.
    BasicImage(int width, int height, int channels, std::vector<Number> values)
        : width(width), height(height), channels(channels), values(std::move(values)) {}

    bool empty() const { return values.empty(); }
    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * height; }

    Number* pixel(int x, int y) {
        assert(x >= 0 && x < width && y >= 0 && y < height);
        return values.data() + (static_cast<std::size_t>(y) * width + x) * channels;
    }
    const Number* pixel(int x, int y) const { return const_cast<BasicImage*>(this)->pixel(x, y); }
    Number& at(int x, int y, int channel) { return pixel(x, y)[channel]; }
    const Number& at(int x, int y, int channel) const { return pixel(x, y)[channel]; }
};

using Image = BasicImage<float>;
using Image64 = BasicImage<double>; ///< for references and truths

template<class To, class From>
BasicImage<To> convert(const BasicImage<From>& from) {
    BasicImage<To> to(from.width, from.height, from.channels);
    for (std::size_t i = 0; i < from.values.size(); ++i)
        to.values[i] = static_cast<To>(from.values[i]);
    return to;
}

} // namespace postfx
