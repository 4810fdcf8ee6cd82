#include <image/metrics.hpp>
#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace postfx {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A NaN or infinity that the other does not have.
bool non_finite_mismatch(float a, float b) {
    if (std::isfinite(a) && std::isfinite(b)) return false;
    return !(std::isnan(a) && std::isnan(b)) && a != b;
}

/// A plane of doubles.
struct Plane {
    int width = 0, height = 0;
    std::vector<double> values;

    Plane(int width, int height)
        : width(width), height(height), values(static_cast<std::size_t>(width) * height) {}
    double* row(int y) { return values.data() + static_cast<std::size_t>(y) * width; }
    const double* row(int y) const { return values.data() + static_cast<std::size_t>(y) * width; }
};

/// Rec. 709 luma, or the first channel of a picture without colour. What is not finite counts as 0: it is the
/// same in both pictures wherever SSIM is taken.
Plane luma(const Image& image) {
    Plane plane(image.width, image.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
        const float* pixel = image.values.data() + i * image.channels;
        const double y =
            image.channels < 3 ? pixel[0] : 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
        plane.values[i] = std::isfinite(y) ? y : 0;
    }
    return plane;
}

/// Gaussian of sigma 1.5 pixels over at most 11 taps, sum 1; fewer where the picture has fewer pixels.
std::vector<double> window(int side) {
    std::vector<double> weights(static_cast<std::size_t>(std::min(side, 11)));
    const double center = (static_cast<double>(weights.size()) - 1) / 2;
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double distance = static_cast<double>(i) - center;
        sum += weights[i] = std::exp(-distance * distance / (2 * 1.5 * 1.5));
    }
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

/// Weighted mean of a * b (or of a, without b) over every window that lies inside the picture.
Plane local_mean(const Plane& a, const Plane* b) {
    const std::vector<double> across = window(a.width), along = window(a.height);
    const auto tap_count = [](const std::vector<double>& weights) {
        return static_cast<int>(weights.size());
    };
    Plane rows(a.width - tap_count(across) + 1, a.height);
    for (int y = 0; y < rows.height; ++y)
        for (int x = 0; x < rows.width; ++x) {
            double sum = 0;
            for (int i = 0; i < tap_count(across); ++i)
                sum += across[i] * a.row(y)[x + i] * (b ? b->row(y)[x + i] : 1.0);
            rows.row(y)[x] = sum;
        }
    Plane means(rows.width, a.height - tap_count(along) + 1);
    for (int y = 0; y < means.height; ++y)
        for (int i = 0; i < tap_count(along); ++i)
            for (int x = 0; x < means.width; ++x)
                means.row(y)[x] += along[i] * rows.row(y + i)[x];
    return means;
}

/// Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image quality assessment: from error visibility to
/// structural similarity", IEEE Transactions on Image Processing 13(4), 2004: equation 13, mean over all
/// windows.
double mean_ssim(const Image& image_a, const Image& image_b, double peak) {
    const double c1 = 0.01 * peak * 0.01 * peak, c2 = 0.03 * peak * 0.03 * peak;
    const Plane a = luma(image_a), b = luma(image_b);
    const Plane mean_a = local_mean(a, nullptr), mean_b = local_mean(b, nullptr);
    const Plane square_a = local_mean(a, &a), square_b = local_mean(b, &b), product = local_mean(a, &b);
    double sum = 0;
    for (std::size_t i = 0; i < product.values.size(); ++i) {
        const double ma = mean_a.values[i], mb = mean_b.values[i];
        // Flat regions of bright pictures: rounding could make a variance negative, or a covariance larger
        // than both.
        const double variance_a = std::max(0.0, square_a.values[i] - ma * ma);
        const double variance_b = std::max(0.0, square_b.values[i] - mb * mb);
        const double bound = std::sqrt(variance_a) * std::sqrt(variance_b);
        const double covariance = std::clamp(product.values[i] - ma * mb, -bound, bound);
        sum += (2 * ma * mb + c1) * (2 * covariance + c2)
               / ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2));
    }
    return sum / static_cast<double>(product.values.size());
}

/// Everything that looks at one pixel at a time.
Difference pixel_differences(const Image& a, const Image& b) {
    Difference difference;
    double sum = 0;
    const auto channels = static_cast<std::size_t>(a.channels);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const float* pa = a.pixel(x, y);
            const float* pb = b.pixel(x, y);
            if (std::memcmp(pa, pb, channels * sizeof(float)) == 0) continue;
            ++difference.differing;
            bool mismatch = false;
            for (std::size_t channel = 0; channel < channels; ++channel) {
                mismatch = mismatch || non_finite_mismatch(pa[channel], pb[channel]);
                if (!std::isfinite(pa[channel]) || !std::isfinite(pb[channel])) continue;
                const double error = std::fabs(static_cast<double>(pa[channel]) - pb[channel]);
                sum += error * error;
                if (error <= difference.max_abs) continue;
                difference.max_abs = error;
                if (difference.non_finite == 0) difference.worst_x = x, difference.worst_y = y;
            }
            if (mismatch && difference.non_finite++ == 0) difference.worst_x = x, difference.worst_y = y;
        }
    difference.rmse =
        difference.non_finite > 0 ? infinity : std::sqrt(sum / static_cast<double>(a.values.size()));
    return difference;
}

template<class Number>
std::string size_text(const BasicImage<Number>& image) {
    return fmt::format("{} x {} pixels of {} channels", image.width, image.height, image.channels);
}

template<class Number>
void require_comparable(const BasicImage<Number>& a, const BasicImage<Number>& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        throw Error(fmt::format("pictures of different size can't be compared: {} and {}", size_text(a),
                                size_text(b)));
    if (a.empty()) throw Error("an empty picture can't be compared");
}

} // namespace

Difference compare(const Image& a, const Image& b, double peak) {
    require_comparable(a, b);
    if (!(peak > 0)) throw Error(fmt::format("full scale is {}, expected more than 0", peak));
    Difference difference = pixel_differences(a, b);
    difference.psnr = difference.rmse > 0 ? 20 * std::log10(peak / difference.rmse) : infinity;
    if (difference.non_finite > 0)
        difference.ssim = 0;
    else if (difference.rmse > 0)
        difference.ssim = mean_ssim(a, b, peak);
    return difference;
}

RelativeError relative_error(const Image64& picture, const Image64& reference) {
    require_comparable(picture, reference);
    const auto channels = static_cast<std::size_t>(picture.channels);
    const std::size_t colors = channels < 3 ? 1 : 3;
    RelativeError error;
    double relative = 0, difference = 0, light = 0;
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        const double* x = picture.values.data() + i * channels;
        const double* r = reference.values.data() + i * channels;
        const auto finite = [](double value) { return std::isfinite(value); };
        if (!std::all_of(x, x + colors, finite) || !std::all_of(r, r + colors, finite)) ++error.non_finite;
        for (std::size_t c = 0; c < colors; ++c) {
            const double square = (x[c] - r[c]) * (x[c] - r[c]), scale = std::fabs(r[c]) + 0.01;
            relative += square / (scale * scale);
            difference += square;
            light += r[c] * r[c];
        }
    }
    if (error.non_finite > 0) {
        error.rel_mse = error.relative_rmse = infinity;
    } else if (difference > 0) {
        error.rel_mse = relative / static_cast<double>(picture.pixel_count() * colors);
        error.relative_rmse = std::sqrt(difference / light);
    }
    return error;
}

} // namespace postfx
