// The vignette's gain as its model has it, and how far a method is from it.
#include <truths/closed_form.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/metric.hpp>

#include <postfx/camera.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

struct Gain {
    bool natural = true;
    double strength = 1;
    double radius = 0, softness = 1, roundness = 1; ///< artistic
    double tangent = 0;           ///< of half the vertical field of view; 0 for parallel rays
    std::array<double, 2> axis{}; ///< as Camera::principal_point
    int width = 1, height = 1;

    /// Light falls on the sensor by the fourth power of the cosine of the angle at which it comes through the lens.
    template<class Number>
    Number shape(Number across, Number up) const {
        if (natural) {
            const Number right = across - Number(axis[0]) * Number(width) / Number(height);
            const Number above = up - Number(axis[1]);
            const Number cosine = 1 / std::hypot(Number(1), right * Number(tangent), above * Number(tangent));
            return cosine * cosine * (cosine * cosine);
        }
        const Number aspect = Number(width) / Number(height);
        // From the picture's own shape to that of its height.
        const Number stretch = 1 / aspect + Number(roundness) * (1 - 1 / aspect);
        const Number from_centre = std::hypot(across * stretch, up) / 2;
        const Number part =
            std::clamp((from_centre - Number(radius)) / Number(softness), Number(0), Number(1));
        return (1 - part) * (1 - part) * (1 + 2 * part);
    }

    template<class Number>
    Number at(int x, int y) const {
        const Number across = Number(2 * x + 1 - width) / Number(height);
        const Number up = Number(2 * y + 1 - height) / Number(height);
        return 1 - Number(strength) * (1 - shape(across, up));
    }
};

class Vignette {
public:
    explicit Vignette(const TruthRequest& request)
        : gain_{.natural = request.value("model") == 0,
                .strength = request.value("strength"),
                .radius = request.value("radius"),
                .softness = request.value("softness"),
                .roundness = request.value("roundness"),
                .tangent = request.scene.camera_at(request.time).tan_half_fov(),
                .axis = request.scene.camera_at(request.time).principal_point,
                .width = request.width,
                .height = request.height},
          color_(given_light(request)) {}

    template<class Number>
    std::array<Number, 3> pixel(int x, int y) const {
        const Number gain = gain_.at<Number>(x, y);
        const double* color = color_.pixel(x, y);
        return {gain * Number(color[0]), gain * Number(color[1]), gain * Number(color[2])};
    }

private:
    Gain gain_;
    Image64 color_;
};

/// On a picture of light 1, by the natural law through a wide lens, in full strength.
double gain_error(const Method& method) {
    constexpr int width = 192, height = 108;
    const MethodInput input{.color = Image(width, height, 3, 1), .camera = Camera::perspective(70, 0.1)};
    const Image64 result = method.draw(entry_with(method, {{"model", 0}, {"strength", 1}}), input);
    const Gain gain{.tangent = input.camera.tan_half_fov(),
                    .axis = input.camera.principal_point,
                    .width = width,
                    .height = height};
    double worst = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            worst = std::max(worst, std::abs(result.at(x, y, 0) - gain.at<double>(x, y)));
    }
    return worst;
}

const RegisterTruth<ClosedForm<Vignette>> registered("vignette", "scene",
                                                     "its law at the angle of each pixel's ray", 2);
const RegisterMetric
    registered_error("vignette", "gain_error", "",
                     "largest error of the gain by the natural law, vertical view 70 degrees", gain_error);

} // namespace
} // namespace postfx::host
