// The vignette's model in float64, with the angles that the GLSL avoids.
#include <testing.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::testing {
namespace {

double natural(double x, double y, const ReferenceInput& input) {
    // The sensor stands 1 away from the lens; x and y are in half picture heights.
    const double aspect = double(input.color.width) / input.color.height;
    const double right = x - input.camera.principal_point[0] * aspect,
                 up = y - input.camera.principal_point[1];
    const double angle = std::atan(std::hypot(right, up) * input.camera.tan_half_fov());
    return std::pow(std::cos(angle), 4);
}

double artistic(double x, double y, const ReferenceInput& input) {
    const double aspect = double(input.color.width) / input.color.height;
    const double roundness = input.value("roundness");
    const double narrowed = x * roundness + x / aspect * (1 - roundness);
    const double heights = 0.5 * std::hypot(narrowed, y);
    const double along = std::clamp((heights - input.value("radius")) / input.value("softness"), 0.0, 1.0);
    return 1 - along * along * (3 - 2 * along);
}

/// Texture coordinates from the centre, whatever the picture's shape.
double classic(double x, double y, const ReferenceInput& input) {
    const double aspect = double(input.color.width) / input.color.height;
    return 1 - std::pow(1.2 * std::hypot(x / aspect, y) / 2, 3);
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const int width = input.color.width, height = input.color.height;
    const double strength = input.value("strength");
    Image64 result(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double across = (2 * x + 1.0 - width) / height, up = (2 * y + 1.0 - height) / height;
            const double shape = input.level == "classic"    ? classic(across, up, input)
                                 : input.value("model") == 0 ? natural(across, up, input)
                                                             : artistic(across, up, input);
            const double gain = 1 - strength * (1 - shape);
            for (int c = 0; c < 3; ++c)
                result.at(x, y, c) = gain * input.color.at(x, y, c);
        }
    }
    return result;
}

} // namespace postfx::testing
