// Depth of fewer pixels than its picture, and how far what was made of it is from the truth.
#pragma once

#include <postfx/image.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::testing {

/// A mean of the nearest four values of one channel; nothing (0) counts as 0.
inline Image bilinear_values(const Image& values, int width, int height) {
    Image result(width, height, 1);
    const auto between = [](double place, int count, int& low, int& high) {
        place = std::clamp(place, 0.0, count - 1.0);
        low = static_cast<int>(place);
        high = std::min(low + 1, count - 1);
        return place - low;
    };
    for (int y = 0; y < height; ++y) {
        int low_y = 0, high_y = 0;
        const double above = between((y + 0.5) * values.height / height - 0.5, values.height, low_y, high_y);
        for (int x = 0; x < width; ++x) {
            int low_x = 0, high_x = 0;
            const double right = between((x + 0.5) * values.width / width - 0.5, values.width, low_x, high_x);
            const auto line = [&](int row) {
                return (1 - right) * static_cast<double>(values.at(low_x, row, 0))
                       + right * static_cast<double>(values.at(high_x, row, 0));
            };
            result.at(x, y, 0) = static_cast<float>((1 - above) * line(low_y) + above * line(high_y));
        }
    }
    return result;
}

struct DepthError {
    double wrong = 0;   ///< share of pixels whose distance is off by more than 5 %
    double nothing = 0; ///< share of pixels that are nothing where something is, or the other way
    double mean = 0;    ///< of |ln(distance / truth)|, where both are something
};

/// Of inverse distances, 0 where nothing is.
inline DepthError depth_error(const Image& found, const Image& truth) {
    DepthError error;
    double surfaces = 0;
    for (std::size_t i = 0; i < truth.values.size(); ++i) {
        const auto a = static_cast<double>(found.values[i]), b = static_cast<double>(truth.values[i]);
        error.nothing += (a > 0) != (b > 0);
        if (!(a > 0 && b > 0)) continue;
        ++surfaces;
        error.mean += std::abs(std::log(a / b));
        error.wrong += std::abs(std::log(a / b)) > std::log(1.05);
    }
    error.mean /= std::max(surfaces, 1.0);
    error.wrong /= static_cast<double>(truth.values.size());
    error.nothing /= static_cast<double>(truth.values.size());
    return error;
}

} // namespace postfx::testing
