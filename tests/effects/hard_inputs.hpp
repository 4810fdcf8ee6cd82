// Hostile inputs for any effect: pictures, geometry and cameras, made from nothing but the names of attachments.
#pragma once

#include <testing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace postfx::testing {

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float infinite = std::numeric_limits<float>::infinity();
inline constexpr float denormal = 1e-40f;
inline constexpr float largest_half = 65504; // the brightest finite light of rgba16f targets

template<class Thing>
struct Named {
    std::string name;
    Thing thing;
};

struct Size {
    int width, height;
};

/// Small enough for thousands of runs, odd, and high enough that sizes given as a few per cent of the height are more
/// than a pixel, since below that effects may rightly do nothing.
inline constexpr Size usual_size{71, 53};
inline constexpr Size hard_sizes[] = {{1, 1},   {1, 7},   {7, 1},   {2, 2},
                                      {17, 31}, {800, 2}, {2, 800}, {8000, 2}};

inline std::string text_of(Size size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// The camera moved up by metres and tilted down so that it looks at the ground and the horizon.
inline Camera lifted(Camera camera, double height) {
    camera.view_to_world = {1, 0, 0, 0, 0, 0.8, -0.6, 0, 0, 0.6, 0.8, 0, 0, height, 0, 1};
    return camera;
}

inline std::vector<Named<Camera>> hard_cameras() {
    using Kind = Camera::DepthKind;
    return {{"reversed infinite", Camera::perspective(45, 0.1)},
            {"reversed, far/near 1e7", Camera::perspective(45, 0.1, 1e6, Kind::reversed)},
            {"standard, far/near 1e7", Camera::perspective(45, 0.1, 1e6, Kind::standard)},
            {"reversed infinite, 1000 km up", lifted(Camera::perspective(45, 0.1), 1e6)},
            {"reversed infinite, 1000 km down", lifted(Camera::perspective(45, 0.1), -1e6)},
            {"orthographic reversed", Camera::parallel(10, 0.1, 100)},
            {"orthographic standard, far/near 1e7", Camera::parallel(10, 0.1, 1e6, Kind::standard)}};
}

/// Distances grow upwards from the near plane to a kilometre or the far plane; the top quarter is sky. Columns differ
/// by up to 2x, so that there are edges everywhere.
inline Image ordinary_depth(Size size, const Camera& camera) {
    Image depth(size.width, size.height, 1);
    const double farthest = std::min(camera.far_plane, 1000.0);
    for (int y = 0; y < size.height; ++y) {
        const double share = static_cast<double>(y) / size.height;
        for (int x = 0; x < size.width; ++x) {
            const double z = camera.near_plane * std::pow(farthest / camera.near_plane, share) * (1 + x % 2);
            const double raw = share > 0.75 ? camera.sky_depth : camera.depth_at(std::min(z, farthest));
            depth.at(x, y, 0) = static_cast<float>(raw);
        }
    }
    return depth;
}

/// Unit vectors in view space that face the camera.
inline Image ordinary_normals(Size size) {
    Image normals = noise(size.width, size.height, -1, 1, 3);
    for (std::size_t i = 0; i < normals.pixel_count(); ++i) {
        float* n = &normals.values[3 * i];
        n[2] = std::abs(n[2]) + 0.1f;
        const float length = std::hypot(n[0], n[1], n[2]);
        for (int c = 0; c < 3; ++c)
            n[c] /= length;
    }
    return normals;
}

/// Noise as light with these attachments beside it.
inline Input ordinary_input(const std::vector<std::string>& attachments, Size size = usual_size,
                            const Camera& camera = Camera::perspective(45, 0.1)) {
    Input input{.color = noise(size.width, size.height, 0, 4), .camera = camera, .time = 1.5, .frame = 7};
    for (const std::string& name : attachments) {
        if (name == "color") continue;
        input.attachments[name] = name == "depth"    ? ordinary_depth(size, camera)
                                  : name == "normal" ? ordinary_normals(size)
                                                     : noise(size.width, size.height, 0, 1, 2);
    }
    return input;
}

/// The same size and attachments, nothing but NaN: what a pass leaves behind where it should have written.
inline Input poison(const Input& input) {
    Input poisoned = input;
    std::fill(poisoned.color.values.begin(), poisoned.color.values.end(), not_a_number);
    for (auto& [name, image] : poisoned.attachments)
        std::fill(image.values.begin(), image.values.end(), not_a_number);
    poisoned.time += 1;
    poisoned.frame += 1;
    return poisoned;
}

/// One pixel in the middle becomes `value`.
inline void put_spot(Image& image, float value) {
    float* middle = image.pixel(image.width / 2, image.height / 2);
    std::fill(middle, middle + image.channels, value);
}

/// Single NaN and infinite pixels amid the others.
inline void put_non_finite(Image& image) {
    const float values[] = {not_a_number, infinite, -infinite};
    for (int i = 0; i < 3; ++i) {
        float* pixel = image.pixel(image.width * (i + 1) / 4, image.height * (i + 1) / 4);
        std::fill(pixel, pixel + image.channels, values[i]);
    }
}

inline void fill(Image& image, float value) {
    std::fill(image.values.begin(), image.values.end(), value);
}

inline std::vector<Named<Image>> hard_colors() {
    const Image ordinary = noise(usual_size.width, usual_size.height, 0, 4);
    std::vector<Named<Image>> colors;
    for (const auto& [name, value] : std::vector<std::pair<std::string, float>>{{"NaN", not_a_number},
                                                                                {"+infinity", infinite},
                                                                                {"-infinity", -infinite},
                                                                                {"-1", -1.0f},
                                                                                {"-5", -5.0f},
                                                                                {"-65504", -largest_half},
                                                                                {"denormal", denormal},
                                                                                {"65504", largest_half},
                                                                                {"-0", -0.0f}}) {
        colors.push_back({"a pixel of " + name, ordinary});
        put_spot(colors.back().thing, value);
        colors.push_back({"all pixels " + name, ordinary});
        fill(colors.back().thing, value);
    }
    colors.push_back({"all black", Image(usual_size.width, usual_size.height, 3)});
    colors.push_back({"a hot pixel on black", colors.back().thing});
    put_spot(colors.back().thing, largest_half);
    colors.push_back({"noise of both signs up to 65504",
                      noise(usual_size.width, usual_size.height, -largest_half, largest_half, 5)});
    return colors;
}

/// Pixels that only a copy preserves: NaN with payloads, signed zeros, infinities, denormals.
inline Image fragile_color() {
    static constexpr std::uint32_t bits[] = {0x7fc12345, 0xffc00001, 0x80000000, 0x00000000, 0x00000001,
                                             0x807fffff, 0x7f800000, 0xff800000, 0x7f7fffff, 0x3dcccccd};
    Image color(usual_size.width, usual_size.height, 3);
    for (std::size_t i = 0; i < color.values.size(); ++i)
        color.values[i] = std::bit_cast<float>(bits[i % std::size(bits)]);
    return color;
}

/// A random word as a number in [0, 1); not uniform_real_distribution: its result differs between standard libraries.
inline double share_of(std::uint_fast32_t word) {
    return static_cast<double>(word >> 8) / 16777216.0;
}

/// So far into the range, by factors where that is how the parameter is meant.
inline double value_at(const ParameterInfo& parameter, double share) {
    if (parameter.logarithmic) {
        return parameter.minimum * std::pow(parameter.maximum / parameter.minimum, share);
    }
    return parameter.minimum + share * (parameter.maximum - parameter.minimum);
}

} // namespace postfx::testing
