// What a lens does to light of which the picture is known: a point out of focus, a sharp edge before a blur.
#include <truths/metric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace postfx::host {
namespace {

/// A strip of a picture of 720 rows, for which levels choose their sizes. The largest circle is the default's.
constexpr int width = 160, height = 720;
constexpr double largest_circle = 0.03 * height; // px
constexpr double focus = 4;                      // metres

ChainEntry lens(const Method& method, const Camera& camera) {
    const double aperture = largest_circle * 2 * focus * camera.tan_half_fov() / height; // metres
    constexpr double picture = 0;
    return entry_with(method, {{"focus_distance", focus},
                               {"f_number", 1},
                               {"focal_length", 1000 * aperture},
                               {"max_circle_of_confusion", largest_circle / height},
                               {"axial_aberration", 0},
                               {"view", picture}});
}

/// Where circles have `share` of the diameter that they have at infinity; below 0 before the focus.
double distance_with(double share) {
    return focus / (1 - share);
}

using Field = std::function<double(int x, int y)>;

MethodInput scene(const Field& light, const Field& distance) {
    MethodInput input{.color = Image(width, height, 3), .camera = Camera::perspective(40, 0.1)};
    Image depth(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::fill_n(input.color.pixel(x, y), 3, static_cast<float>(light(x, y)));
            depth.at(x, y, 0) = static_cast<float>(input.camera.depth_at(distance(x, y)));
        }
    }
    input.camera.focus_distance = focus;
    input.attachments["depth"] = std::move(depth);
    return input;
}

/// Largest relative change of the light of a point that is out of focus, before and behind the focus, in the middle
/// of a wall.
double point_energy(const Method& method) {
    constexpr double light = 100;
    double worst = 0;
    for (const double share : {-0.9, -0.4, 0.4, 0.9}) {
        for (const int phase : {0, 1, 2}) { // left, right and beyond in a block of a coarser layer
            const int x0 = width / 2 + phase, y0 = height / 2 + 1;
            const MethodInput input = scene([&](int x, int y) { return x == x0 && y == y0 ? light : 0; },
                                            [&](int, int) { return distance_with(share); });
            const Image64 found = method.draw(lens(method, input.camera), input);
            double sum = 0;
            for (std::size_t i = 1; i < found.values.size(); i += 3)
                sum += found.values[i];
            worst = std::max(worst, std::abs(sum / light - 1));
        }
    }
    return worst;
}

/// A sharp surface on the left before a blurred one on the right, of constant light each, is to stay the step that it
/// is. What is found beyond the step, as a share of what the bright side has as far as the largest circle reaches;
/// the worse of bright before dark and dark before bright.
double leakage(const Method& method) {
    constexpr int reach = static_cast<int>(largest_circle);
    double worst = 0;
    for (const bool is_bright_before : {true, false}) {
        for (const int edge :
             {width / 2 - 1, width / 2}) { // within a block of a coarser layer and between two
            const double left = is_bright_before ? 1 : 0;
            const MethodInput input =
                scene([&](int x, int) { return x < edge ? left : 1 - left; },
                      [&](int x, int) { return x < edge ? focus : distance_with(0.9); });
            const Image64 found = method.draw(lens(method, input.camera), input);
            double sum = 0;
            for (int i = 0; i < reach; ++i)
                sum += found.at(is_bright_before ? edge + i : edge - 1 - i, height / 2, 1);
            worst = std::max(worst, sum / reach);
        }
    }
    return worst;
}

const RegisterMetric
    energy_metric("depth_of_field", "energy", "",
                  "largest relative change of the light of a point out of focus, circles of 9 and 19 px",
                  point_energy),
    leakage_metric("depth_of_field", "leakage", "",
                   "light beyond a sharp edge before a blur, as a share of the bright side", leakage);

} // namespace
} // namespace postfx::host
