#include <image/flip.hpp>

#include <image/cielab.hpp>
#include <image/srgb.hpp>
#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace postfx {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Plane = Image64;               ///< one channel
using Kernel = std::vector<double>;  ///< odd count, centre in the middle
using Planes = std::array<Plane, 3>; ///< one colour per pixel

// ---- filters ------------------------------------------------------------------------------------------------------

/// Values of `weight(distance in pixels)` from -radius to radius.
template<class Weight>
Kernel kernel(int radius, Weight weight) {
    Kernel result;
    for (int i = -radius; i <= radius; ++i)
        result.push_back(weight(i));
    return result;
}

double sum(const Kernel& kernel) {
    double result = 0;
    for (double weight : kernel)
        result += weight;
    return result;
}

/// Outside the picture its border pixel goes on, here and in along_columns.
Plane along_rows(const Plane& plane, const Kernel& kernel) {
    const std::size_t radius = kernel.size() / 2, width = static_cast<std::size_t>(plane.width);
    Plane result(plane.width, plane.height, 1);
    std::vector<double> padded(width + 2 * radius);
    for (int y = 0; y < plane.height; ++y) {
        const double* from = plane.pixel(0, y);
        double* to = result.pixel(0, y);
        std::fill_n(padded.begin(), radius, from[0]);
        std::copy_n(from, width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, from[width - 1]);
        for (std::size_t tap = 0; tap < kernel.size(); ++tap)
            for (std::size_t x = 0; x < width; ++x)
                to[x] += kernel[tap] * padded[x + tap];
    }
    return result;
}

Plane along_columns(const Plane& plane, const Kernel& kernel) {
    const int taps = static_cast<int>(kernel.size()), radius = taps / 2;
    Plane result(plane.width, plane.height, 1);
    for (int y = 0; y < plane.height; ++y) {
        double* to = result.pixel(0, y);
        for (int tap = 0; tap < taps; ++tap) {
            const double* from = plane.pixel(0, std::clamp(y + tap - radius, 0, plane.height - 1));
            const double weight = kernel[static_cast<std::size_t>(tap)];
            for (int x = 0; x < plane.width; ++x)
                to[x] += weight * from[x];
        }
    }
    return result;
}

// ---- colour pipeline --------------------------------------------------------------------------------

/// Spatial filtering: the contrast sensitivity of one opponent channel is, seen as a filter over the
/// visual angle x [degrees], the sum of a sqrt(pi / b) exp(-pi^2 x^2 / b) over two terms; b in degrees squared.
struct Term {
    double a, b;
};
using Sensitivity = std::array<Term, 2>;
constexpr double widest_b = 0.04;
constexpr std::array<Sensitivity, 3> sensitivities = {{
    {{{1, 0.0047}, {0, 1e-5}}},          // Y: achromatic
    {{{1, 0.0053}, {0, 1e-5}}},          // Cx: red to green
    {{{34.1, widest_b}, {13.5, 0.025}}}, // Cz: blue to yellow
}};

/// One opponent channel as the eye resolves it: each term is a Gaussian, so separable. All channels are cut at
/// three standard deviations of the widest term, and the weights of the whole filter add up to 1.
Plane seen(const Plane& plane, const Sensitivity& sensitivity, double ppd) {
    constexpr double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest_b / (2 * pi * pi)) * ppd));
    Plane result(plane.width, plane.height, 1);
    double total = 0;
    for (const auto& [a, b] : sensitivity) {
        if (a == 0) continue;
        const Kernel gaussian =
            kernel(radius, [&, b = b](int i) { return std::exp(-pi * pi * i * i / (ppd * ppd * b)); });
        const double factor = a * std::sqrt(pi / b);
        const Plane filtered = along_columns(along_rows(plane, gaussian), gaussian);
        for (std::size_t i = 0; i < result.values.size(); ++i)
            result.values[i] += factor * filtered.values[i];
        total += factor * sum(gaussian) * sum(gaussian);
    }
    for (double& value : result.values)
        value /= total;
    return result;
}

/// Spatial filtering happens in YCxCz, opponent colours linear in the light, so that filtering blends light.
Triple opponent(const Triple& linear) {
    const Triple xyz = linear_to_xyz(linear);
    const Triple& white = white_xyz();
    const double x = xyz[0] / white[0], y = xyz[1] / white[1], z = xyz[2] / white[2];
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Triple from_opponent(const Triple& ycxcz) {
    const Triple& white = white_xyz();
    const double y = (ycxcz[0] + 16) / 116;
    return xyz_to_linear({white[0] * (y + ycxcz[1] / 500), white[1] * y, white[2] * (y - ycxcz[2] / 200)});
}

/// The perceptually uniform colours: L*a*b* whose chroma grows with luminance, the Hunt effect.
Triple hunt_adjusted_lab(const Triple& linear) {
    const Triple lab = xyz_to_lab(linear_to_xyz(linear));
    return {lab[0], 0.01 * lab[0] * lab[1], 0.01 * lab[0] * lab[2]};
}

/// The colour metric is the HyAB distance: city block between lightness and chroma, Euclidean within chroma.
double hyab(const Triple& a, const Triple& b) {
    return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Error redistribution: large distances are compressed (q_c), and the range below p_c of the largest distance there
/// is, between green and blue, gets p_t of [0, 1]: what is larger looks just as wrong.
double color_error(const Triple& a, const Triple& b) {
    constexpr double q_c = 0.7, p_c = 0.4, p_t = 0.95;
    static const double largest =
        std::pow(hyab(hunt_adjusted_lab({0, 1, 0}), hunt_adjusted_lab({0, 0, 1})), q_c);
    const double error = std::pow(hyab(a, b), q_c), bend = p_c * largest;
    if (error < bend) return p_t / bend * error;
    return std::min(1.0, p_t + (error - bend) / (largest - bend) * (1 - p_t));
}

/// Hunt-adjusted L*a*b* of what the eye resolves; light beyond what a display can show is clamped.
std::vector<Triple> perceived_colors(const Planes& ycxcz, double ppd) {
    Planes filtered;
    for (std::size_t c = 0; c < 3; ++c)
        filtered[c] = seen(ycxcz[c], sensitivities[c], ppd);
    std::vector<Triple> colors;
    colors.reserve(filtered[0].values.size());
    for (std::size_t i = 0; i < filtered[0].values.size(); ++i) {
        Triple linear = from_opponent({filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]});
        for (double& light : linear)
            light = std::clamp(light, 0.0, 1.0);
        colors.push_back(hunt_adjusted_lab(linear));
    }
    return colors;
}

// ---- feature pipeline -------------------------------------------------------------------------------

/// Weights whose positive ones add up to 1 and whose negative ones to -1, so that the largest response is 1.
Kernel balanced(Kernel kernel) {
    double positive = 0, negative = 0;
    for (double weight : kernel)
        (weight > 0 ? positive : negative) += std::fabs(weight);
    for (double& weight : kernel)
        weight /= weight > 0 ? positive : negative;
    return kernel;
}

/// How much of an edge and of a point (or thin line) there is in every pixel, 0 to sqrt 2.
struct Features {
    Plane edges, points;
};

Plane lengths(const Plane& x, const Plane& y) {
    Plane result(x.width, x.height, 1);
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = std::hypot(x.values[i], y.values[i]);
    return result;
}

/// Feature detection: first and second derivatives of a Gaussian as wide as the eye's edge detector, 0.082 degrees
/// from peak to trough. `luminance` in [0, 1].
Features detected_features(const Plane& luminance, double ppd) {
    const double deviation = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    Kernel blur = kernel(radius, gaussian);
    const double blur_sum = sum(blur);
    for (double& weight : blur)
        weight /= blur_sum;
    const Kernel slope = balanced(kernel(radius, [&](int i) { return -i * gaussian(i); }));
    const Kernel curvature =
        balanced(kernel(radius, [&](int i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); }));
    const Plane blurred_rows = along_rows(luminance, blur), blurred_columns = along_columns(luminance, blur);
    return {lengths(along_rows(blurred_columns, slope), along_columns(blurred_rows, slope)),
            lengths(along_rows(blurred_columns, curvature), along_columns(blurred_rows, curvature))};
}

/// The feature metric: an edge or point that only one picture has, 0 to 1.
double feature_error(double edge_a, double edge_b, double point_a, double point_b) {
    constexpr double q_f = 0.5;
    const double difference = std::max(std::fabs(edge_a - edge_b), std::fabs(point_a - point_b));
    return std::pow(std::numbers::sqrt2 / 2 * difference, q_f);
}

// ---- whole pictures -----------------------------------------------------------------------------------------------

bool finite(const Triple& color) {
    return std::all_of(color.begin(), color.end(), [](double value) { return std::isfinite(value); });
}

bool displayable(const Triple& color) {
    return std::all_of(color.begin(), color.end(), [](double value) { return value >= 0 && value <= 1; });
}

Triple color_of(const Image& image, std::size_t index) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const float* pixel = image.values.data() + index * channels;
    if (channels < 3) return {pixel[0], pixel[0], pixel[0]};
    return {pixel[0], pixel[1], pixel[2]};
}

/// Opponent colours of what a display shows; a pixel that isn't finite is black here and infinity in the map.
Planes displayed(const Image& image, Encoding encoding) {
    Planes planes;
    planes.fill(Plane(image.width, image.height, 1));
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        Triple color = color_of(image, i);
        if (!finite(color)) color = {0, 0, 0};
        for (double& value : color) {
            value = std::clamp(value, 0.0, 1.0);
            if (encoding == Encoding::srgb) value = srgb_to_linear(value);
        }
        const Triple ycxcz = opponent(color);
        for (std::size_t c = 0; c < 3; ++c)
            planes[c].values[i] = ycxcz[c];
    }
    return planes;
}

struct Seen {
    std::vector<Triple> colors;
    Features features;
};

Seen look_at(const Image& image, Encoding encoding, double ppd) {
    Planes ycxcz = displayed(image, encoding);
    std::vector<Triple> colors = perceived_colors(ycxcz, ppd);
    for (double& y : ycxcz[0].values)
        y = (y + 16) / 116;
    return {std::move(colors), detected_features(ycxcz[0], ppd)};
}

/// The final difference, colour^(1 - feature): a feature that only one picture has makes a colour error worse.
Plane error_map(const Seen& a, const Seen& b) {
    Plane map(a.features.edges.width, a.features.edges.height, 1);
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        const double feature = feature_error(a.features.edges.values[i], b.features.edges.values[i],
                                             a.features.points.values[i], b.features.points.values[i]);
        map.values[i] = std::pow(color_error(a.colors[i], b.colors[i]), 1 - feature);
    }
    return map;
}

/// Counts what can't be displayed and marks in the map what isn't finite.
void judge_pixels(const Image& a, const Image& b, Plane& map, FlipError& error) {
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        const Triple in_a = color_of(a, i), in_b = color_of(b, i);
        if (!finite(in_a) || !finite(in_b)) {
            ++error.non_finite;
            map.values[i] = infinity;
        } else if (!displayable(in_a) || !displayable(in_b)) {
            ++error.clipped;
        }
    }
}

/// Pooling: the value at which the sorted errors have added up to `share` of their sum.
double weighted_quantile(const std::vector<double>& sorted, double total, double share) {
    double running = 0;
    for (double value : sorted) {
        running += value;
        if (running > share * total) return value;
    }
    return sorted.back();
}

void pool(const Plane& map, FlipError& error) {
    if (error.non_finite > 0) {
        error.mean = error.min = error.max = infinity;
        error.weighted_first_quartile = error.weighted_median = error.weighted_third_quartile = infinity;
        return;
    }
    std::vector<double> sorted = map.values;
    std::sort(sorted.begin(), sorted.end());
    const double total = sum(sorted);
    error.mean = total / static_cast<double>(sorted.size());
    error.min = sorted.front();
    error.max = sorted.back();
    error.weighted_first_quartile = weighted_quantile(sorted, total, 0.25);
    error.weighted_median = weighted_quantile(sorted, total, 0.5);
    error.weighted_third_quartile = weighted_quantile(sorted, total, 0.75);
}

} // namespace

FlipError flip(const Image& reference, const Image& test, Encoding encoding, double pixels_per_degree) {
    if (reference.width != test.width || reference.height != test.height)
        throw Error(fmt::format("pictures of different size can't be compared: {} x {} and {} x {} pixels",
                                reference.width, reference.height, test.width, test.height));
    if (reference.empty() || test.empty()) throw Error("an empty picture can't be compared");
    if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000))
        throw Error(fmt::format("{} pixels per degree, expected 1 to 1000", pixels_per_degree));
    Plane map = error_map(look_at(reference, encoding, pixels_per_degree),
                          look_at(test, encoding, pixels_per_degree));
    FlipError error;
    judge_pixels(reference, test, map, error);
    pool(map, error);
    error.map = convert<float>(map);
    return error;
}

} // namespace postfx
