// The tone mapping operators in float64, in their published forms.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace postfx::testing {
namespace {

using Color = std::array<double, 3>;
using Rows = std::array<Color, 3>;

Color times(const Rows& rows, const Color& v) {
    Color result;
    for (int i = 0; i < 3; ++i)
        result[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
    return result;
}

Color aces(Color light) {
    constexpr Rows input = {
        {{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}}};
    constexpr Rows output = {
        {{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}}};
    for (double& value : light)
        value /= 0.6;
    Color film = times(input, light);
    for (double& v : film)
        v = (v * v + 0.0245786 * v) / (0.983729 * v * v + 0.4329510 * v + 0.238081);
    return times(output, film);
}

Color reinhard(const Color& light, double white) {
    const double before = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    if (before == 0) return {0, 0, 0};
    const double after = before * (1 + before / std::pow(white, 2)) / (1 + before);
    const double grey = std::min(after, 1.0);
    Color mapped;
    for (int i = 0; i < 3; ++i)
        mapped[i] = light[i] / before * after;
    const double brightest = *std::max_element(mapped.begin(), mapped.end());
    if (brightest > 1) {
        // The share of the way from grey to the colour at which the brightest channel is 1.
        const double share = (1 - grey) / (brightest - grey);
        for (double& value : mapped)
            value = grey * (1 - share) + value * share;
    }
    return mapped;
}

double hable(double x) {
    const double a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

Color map(const Color& light, int index, double white) {
    switch (index) {
    case 0:
        return aces(light);
    case 1:
        return reinhard(light, white);
    case 2:
        return {hable(2 * light[0]) / hable(11.2), hable(2 * light[1]) / hable(11.2),
                hable(2 * light[2]) / hable(11.2)};
    default:
        return light;
    }
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const int width = input.color.width, height = input.color.height;
    Image64 result(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Color light;
            for (int c = 0; c < 3; ++c) {
                const double exposed = input.color.at(x, y, c) * std::pow(2, input.value("exposure"));
                light[c] = std::isnan(exposed) ? 0 : std::clamp(exposed, 0.0, 65504.0);
            }
            const Color mapped = map(light, static_cast<int>(input.value("operator")), input.value("white"));
            for (int c = 0; c < 3; ++c)
                result.at(x, y, c) = std::clamp(mapped[c], 0.0, 1.0);
        }
    }
    return result;
}

} // namespace postfx::testing
