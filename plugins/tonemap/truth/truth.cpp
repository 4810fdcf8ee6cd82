// Tone curves in their published forms, and how far a method is from them.
#include <truths/closed_form.hpp>
#include <truths/drawn_scene.hpp>
#include <truths/metric.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

template<class Number>
using Color = std::array<Number, 3>;

enum Operator { aces, reinhard, hable, clamped };

template<class Number>
Number dot(const Color<double>& weights, const Color<Number>& color) {
    Number sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        sum += Number(weights[i]) * color[i];
    return sum;
}

/// Hill 2016, without the constant that would make all light below 0.002 black; grey 0.18 gives 0.21.
template<class Number>
Color<Number> aces_curve(const Color<Number>& light) {
    constexpr std::array<Color<double>, 3> into = {
        {{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}}};
    constexpr std::array<Color<double>, 3> back = {
        {{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}}};
    Color<Number> film, result;
    for (std::size_t i = 0; i < 3; ++i) {
        const Number v = dot(into[i], light) / Number(0.6L);
        const Number rising = v * v + Number(0.0245786L) * v;
        film[i] = rising / (Number(0.983729L) * v * v + Number(0.4329510L) * v + Number(0.238081L));
    }
    for (std::size_t i = 0; i < 3; ++i)
        result[i] = dot(back[i], film);
    return result;
}

/// Reinhard et al. 2002, equation 4, of luminance. What is then too bright in a channel goes towards grey of the same
/// luminance until it fits.
template<class Number>
Color<Number> reinhard_curve(const Color<Number>& light, double white) {
    const Number before = dot({0.2126, 0.7152, 0.0722}, light), squared = Number(white) * Number(white);
    const Number after = before * (squared + before) / (squared * (1 + before));
    const Number grey = std::min(after, Number(1));
    Color<Number> result{};
    if (before == 0) return result;
    for (std::size_t i = 0; i < 3; ++i)
        result[i] = light[i] * after / before;
    const Number brightest = *std::max_element(result.begin(), result.end());
    if (brightest <= 1) return result;
    for (Number& value : result)
        value = grey + (value - grey) * (1 - grey) / (brightest - grey);
    return result;
}

/// Hable 2010, before its division by the value at white.
template<class Number>
Number hable_curve(Number x) {
    constexpr long double a = 0.15L, b = 0.5L, c = 0.1L, d = 0.2L, e = 0.02L, f = 0.3L;
    return (x * (Number(a) * x + Number(c * b)) + Number(d * e))
               / (x * (Number(a) * x + Number(b)) + Number(d * f))
           - Number(e / f);
}

/// Display-linear, 0 to 1.
template<class Number>
Color<Number> displayed(const double* color, Operator which, double exposure, double white) {
    Color<Number> light;
    for (std::size_t i = 0; i < 3; ++i) {
        const Number exposed = Number(color[i]) * std::exp2(Number(exposure));
        light[i] = exposed > 0 ? std::min(exposed, Number(65504)) : Number(0); // NaN is black too
    }
    if (which == aces) light = aces_curve(light);
    if (which == reinhard) light = reinhard_curve(light, white);
    if (which == hable) {
        for (Number& value : light)
            value = hable_curve(2 * value) / hable_curve(Number(11.2L));
    }
    for (Number& value : light)
        value = std::clamp(value, Number(0), Number(1));
    return light;
}

class Tonemap {
public:
    explicit Tonemap(const TruthRequest& request)
        : which_(static_cast<Operator>(request.value("operator"))), exposure_(request.value("exposure")),
          white_(request.value("white")), color_(given_light(request)) {}

    template<class Number>
    std::array<Number, 3> pixel(int x, int y) const {
        return displayed<Number>(color_.pixel(x, y), which_, exposure_, white_);
    }

private:
    Operator which_;
    double exposure_, white_;
    Image64 color_;
};

/// Every operator, over colours of many kinds from 1e-4 to 1e4.
double curve_error(const Method& method) {
    constexpr int brightnesses = 256;
    constexpr std::array<Color<double>, 6> kinds = {
        {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0.5, 0.1}, {0.1, 0.3, 1}}};
    MethodInput input{.color = Image(brightnesses, static_cast<int>(kinds.size()), 3)};
    for (int y = 0; y < input.color.height; ++y) {
        for (int x = 0; x < brightnesses; ++x) {
            const double brightness = std::pow(10, -4 + 8.0 * x / (brightnesses - 1));
            for (std::size_t c = 0; c < 3; ++c)
                input.color.pixel(x, y)[c] =
                    static_cast<float>(brightness * kinds[static_cast<std::size_t>(y)][c]);
        }
    }
    const Image64 light = convert<double>(input.color);
    constexpr double exposure = 0.5, white = 4;
    double worst = 0;
    for (const Operator which : {aces, reinhard, hable, clamped}) {
        const Image64 result = method.draw(
            entry_with(method, {{"operator", which}, {"exposure", exposure}, {"white", white}}), input);
        for (int y = 0; y < light.height; ++y) {
            for (int x = 0; x < light.width; ++x) {
                const auto expected = displayed<double>(light.pixel(x, y), which, exposure, white);
                for (int c = 0; c < 3; ++c)
                    worst =
                        std::max(worst, std::abs(result.at(x, y, c) - expected[static_cast<std::size_t>(c)]));
            }
        }
    }
    return worst;
}

const RegisterTruth<ClosedForm<Tonemap>> registered("tonemap", "layer", "its curve at each pixel's light", 2);
const RegisterMetric registered_error("tonemap", "curve_error", "",
                                      "largest error of any curve, light from 1e-4 to 1e4", curve_error);

} // namespace
} // namespace postfx::host
