// The model of README.md in float64: separable passes over whole rows, weights multiplied out from their
// factors, upsampling from the definition of linear interpolation.
#include <testing.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using postfx::Image64;
using postfx::testing::ReferenceInput;

namespace {

using Line = std::vector<double>;

/// Product of two polynomials given by their coefficients.
Line multiply(const Line& a, const Line& b) {
    Line product(a.size() + b.size() - 1, 0.0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j)
            product[i + j] += a[i] * b[j];
    }
    return product;
}

double at_edge_clamped(const Line& line, long i) {
    return line[static_cast<std::size_t>(std::clamp(i, 0L, static_cast<long>(line.size()) - 1))];
}

/// Every second place of the convolution with `kernel`, whose middle lies between texels 2i and 2i + 1.
Line halve(const Line& line, const Line& kernel) {
    Line result((line.size() + 1) / 2);
    const long before = static_cast<long>(kernel.size()) / 2 - 1;
    for (std::size_t i = 0; i < result.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            sum +=
                kernel[k] * at_edge_clamped(line, 2 * static_cast<long>(i) + static_cast<long>(k) - before);
        }
        result[i] = sum;
    }
    return result;
}

/// Linear interpolation; texel i is centred on i + 0.5.
double interpolate(const Line& line, double position) {
    const double left = std::floor(position - 0.5);
    const double fraction = position - 0.5 - left;
    const long i = static_cast<long>(left);
    return (1 - fraction) * at_edge_clamped(line, i) + fraction * at_edge_clamped(line, i + 1);
}

Line enlarge(const Line& line, std::size_t size, bool with_tent) {
    Line result(size);
    for (std::size_t i = 0; i < size; ++i) {
        const double position = (static_cast<double>(i) + 0.5) / 2;
        result[i] = with_tent ? 0.25 * interpolate(line, position - 1) + 0.5 * interpolate(line, position)
                                    + 0.25 * interpolate(line, position + 1)
                              : interpolate(line, position);
    }
    return result;
}

/// Apply `change` to every row, then to every column, of every channel.
template<class Change>
Image64 separably(const Image64& image, int width, int height, Change change) {
    Image64 wide(width, image.height, 3);
    Image64 result(width, height, 3);
    for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < image.height; ++y) {
            Line row(static_cast<std::size_t>(image.width));
            for (int x = 0; x < image.width; ++x)
                row[static_cast<std::size_t>(x)] = image.at(x, y, c);
            row = change(row, static_cast<std::size_t>(width));
            for (int x = 0; x < width; ++x)
                wide.at(x, y, c) = row[static_cast<std::size_t>(x)];
        }
        for (int x = 0; x < width; ++x) {
            Line column(static_cast<std::size_t>(image.height));
            for (int y = 0; y < image.height; ++y)
                column[static_cast<std::size_t>(y)] = wide.at(x, y, c);
            column = change(column, static_cast<std::size_t>(height));
            for (int y = 0; y < height; ++y)
                result.at(x, y, c) = column[static_cast<std::size_t>(y)];
        }
    }
    return result;
}

Image64 half_size(const Image64& image, const Line& kernel) {
    return separably(image, (image.width + 1) / 2, (image.height + 1) / 2,
                     [&](const Line& line, std::size_t) { return halve(line, kernel); });
}

Image64 resized(const Image64& image, int width, int height, bool with_tent) {
    return separably(image, width, height,
                     [&](const Line& line, std::size_t size) { return enlarge(line, size, with_tent); });
}

double repaired(double x) {
    if (std::isnan(x) || x < 0) return 0;
    return std::isinf(x) ? 65504 : x;
}

/// The light that is scattered: repaired, and in threshold mode what is above the soft threshold.
Image64 scattering_light(const ReferenceInput& input) {
    const bool emission = input.value("mode") == 2;
    const Image64& source = emission ? input.attachments.at("emission") : input.color;
    Image64 light(source.width, source.height, 3);
    for (int y = 0; y < source.height; ++y) {
        for (int x = 0; x < source.width; ++x) {
            double brightest = 0;
            for (int c = 0; c < 3; ++c) {
                light.at(x, y, c) = repaired(source.at(x, y, c));
                brightest = std::max(brightest, light.at(x, y, c));
            }
            if (input.value("mode") != 1) continue;
            const double threshold = input.value("threshold");
            const double knee = threshold * input.value("knee");
            double passed = std::max(brightest - threshold, 0.0);
            if (std::abs(brightest - threshold) < knee) {
                passed = std::pow(brightest - threshold + knee, 2) / (4 * knee);
            }
            for (int c = 0; c < 3; ++c)
                light.at(x, y, c) *= brightest > 0 ? passed / brightest : 0;
        }
    }
    return light;
}

/// Weight of each level's blur, finest first, summing to min(octaves, 1).
Line level_weights(double octaves) {
    Line weights;
    double sum = 0;
    for (int level = 1; level < octaves + 1; ++level) {
        const double weight = level <= octaves ? std::pow(2, -0.5 * (octaves - level)) : octaves - level + 1;
        weights.push_back(weight);
        sum += weight;
    }
    for (double& weight : weights)
        weight *= std::min(octaves, 1.0) / sum;
    return weights;
}

/// Of a level's whole way down and up, in pixels of the picture.
double level_variance(std::size_t level) {
    constexpr double smooth = 3 * 0.25, pair = 1, linear = 0.75, tent = 2; // of the factors of the kernels
    double variance = smooth + linear;
    for (std::size_t finer = 1; finer < level; ++finer)
        variance += std::pow(4, finer) * (smooth + pair + linear + (finer == 1 ? 0 : tent));
    return variance;
}

/// The weights whose kernel has this standard deviation; the widest that fit if there is none.
Line weights_for(double deviation, int longer_side) {
    double low = 0, high = std::max(1.0, std::ceil(std::log2(longer_side)));
    const double widest = high;
    for (int step = 0; step < 60; ++step) {
        const double middle = (low + high) / 2;
        const Line weights = level_weights(middle);
        double variance = 0;
        for (std::size_t i = 0; i < weights.size(); ++i)
            variance += weights[i] * level_variance(i + 1);
        (variance < deviation * deviation ? low : high) = middle;
    }
    return level_weights(std::min(high, widest));
}

} // namespace

Image64 postfx::testing::reference(const ReferenceInput& input) {
    const int width = input.color.width;
    const int height = input.color.height;
    const Line weights = weights_for(input.value("radius") * height, std::max(width, height));
    const Line twice_averaged = {0.5, 0.5};
    const Line smooth = multiply(twice_averaged, multiply(twice_averaged, twice_averaged));
    std::vector<Image64> levels = {half_size(scattering_light(input), smooth)};
    while (levels.size() < weights.size())
        levels.push_back(half_size(levels.back(), multiply(smooth, {0.5, 0, 0.5})));

    Image64 sum(levels.back().width, levels.back().height, 3);
    for (std::size_t level = levels.size(); level-- > 0;) {
        if (sum.width != levels[level].width || sum.height != levels[level].height) {
            sum = resized(sum, levels[level].width, levels[level].height, level > 0);
        }
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += weights[level] * levels[level].values[i];
    }
    const Image64 glow = resized(sum, width, height, false);

    double total = 0;
    for (double weight : weights)
        total += weight;
    const double intensity = input.value("intensity");
    const double kept = input.value("mode") == 0 ? 1 - intensity * total : 1;
    Image64 result(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double tint = input.value("tint." + std::to_string(c));
                const double own = input.color.at(x, y, c);
                double added = intensity * tint * glow.at(x, y, c);
                if (input.value("mode") != 0) added = std::min(added, std::max(0.0, 65504 - own));
                result.at(x, y, c) = kept * own + added;
            }
        }
    }
    return result;
}
