// Pictures with depth that the tests of depth of field are made of.
#pragma once

#include <testing.hpp>

#include <algorithm>
#include <functional>
#include <limits>

namespace postfx::testing {

enum LevelIndex { low, medium, ultra, reference_level, classic };
inline constexpr const char* level_names[] = {"low", "medium", "ultra", "reference", "classic"};
inline constexpr int gathering_levels[] = {low, medium, ultra, reference_level};

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Raw depth samples for distances in metres.
inline Image depth_of(int width, int height, const Camera& camera,
                      const std::function<double(int, int)>& distance) {
    Image depth(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            depth.at(x, y, 0) = static_cast<float>(camera.depth_at(distance(x, y)));
    }
    return depth;
}

/// A lens whose circle at infinity is `diameter` pixels in a picture of `height` pixels, focused at 4 m (or
/// the largest that there is, in pictures of few rows).
inline Values lens(double diameter, int height, const Camera& camera, int level = medium) {
    const double aperture = diameter * 2 * 4 * camera.tan_half_fov() / height;
    return {{"focus_distance", 4},
            {"focal_length", std::min(1000 * aperture, 1000.0)},
            {"f_number", 1},
            {"max_circle_of_confusion", 0.1},
            {"quality", level_names[level]}};
}
/// Where that lens has a circle of `diameter` times that at infinity (below 0: before the focus plane).
inline double distance_with(double relative_diameter) {
    return 4 / (1 - relative_diameter);
}

inline const Camera perspective = Camera::perspective(40, 0.1);

inline Input scene(Image color, const std::function<double(int, int)>& distance) {
    const int width = color.width, height = color.height;
    return {.color = std::move(color),
            .attachments = {{"depth", depth_of(width, height, perspective, distance)}},
            .camera = perspective};
}

/// The same light in all channels.
inline Image painted(int width, int height, const std::function<double(int, int)>& light) {
    Image color(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            std::fill_n(color.pixel(x, y), 3, static_cast<float>(light(x, y)));
    }
    return color;
}

inline Worst against_reference(const Input& input, const Values& values) {
    return worst_difference(run_effect("depth_of_field", input, values),
                            reference(reference_input("depth_of_field", input, values)));
}

} // namespace postfx::testing
