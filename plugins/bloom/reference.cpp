// The model of README.md in float64: every blur of the sum by itself, down and up again, in separable passes over
// whole rows.
#include <testing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

using postfx::Image64;
using postfx::testing::ReferenceInput;

namespace {

using Line = std::vector<double>;
constexpr double scatter = 0, threshold = 1, emission = 2; // values of `mode`
constexpr double brightest = 65504;                        // light: the largest half float
enum Level { low, medium, high, ultra, best, classic };

/// (1 + z)^n / 2^n
Line binomial(int n) {
    Line line = {1};
    for (int i = 0; i < n; ++i) {
        Line next(line.size() + 1, 0.0);
        for (std::size_t k = 0; k < line.size(); ++k) {
            next[k] += line[k] / 2;
            next[k + 1] += line[k] / 2;
        }
        line = next;
    }
    return line;
}

/// Linear interpolation between texel centres; the outer texels go on for ever.
double interpolated(const Line& line, double place) {
    const double left = std::floor(place - 0.5), part = place - 0.5 - left;
    const auto texel = [&](double i) {
        return line[static_cast<std::size_t>(std::clamp(i, 0.0, static_cast<double>(line.size()) - 1))];
    };
    return (1 - part) * texel(left) + part * texel(left + 1);
}

/// The line goes on as its mirror image at 0 and at `extent`, which need not be where its last texel ends.
double mirrored(const Line& line, double extent, double place) {
    return interpolated(line, extent - std::abs(extent - std::abs(place)));
}

/// Every second place of the convolution with `kernel`, whose middle lies between texels 2i and 2i + 1, and whose
/// weights are taken in pairs: between two texels.
Line halved(const Line& line, double extent, const Line& kernel) {
    Line result((line.size() + 1) / 2, 0.0);
    const double first = 0.5 - static_cast<double>(kernel.size()) / 2;
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t k = 0; k + 1 < kernel.size(); k += 2) {
            const double weight = kernel[k] + kernel[k + 1];
            const double middle = 2 * static_cast<double>(i) + 1;
            result[i] +=
                weight
                * mirrored(line, extent, middle + first + static_cast<double>(k) + kernel[k + 1] / weight);
        }
    }
    return result;
}

/// The kernel's texels stand `step` apart, and mirror images go on at both ends. The middle one is the texel itself,
/// even if that lies over the end.
Line spread(const Line& line, double extent, const Line& kernel, double step) {
    Line result(line.size(), 0.0);
    const std::size_t middle = kernel.size() / 2;
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = kernel[middle] * line[i];
        for (std::size_t k = 1; k <= middle; ++k) {
            const double place = static_cast<double>(i) + 0.5, offset = step * static_cast<double>(k);
            result[i] +=
                kernel[middle - k] * mirrored(line, extent, std::remainder(place - offset, 2 * extent));
            result[i] +=
                kernel[middle + k] * mirrored(line, extent, std::remainder(place + offset, 2 * extent));
        }
    }
    return result;
}

/// Texels of a line `block` times as fine, by linear interpolation.
Line interpolated_line(const Line& line, std::size_t size, double block) {
    Line result(size);
    for (std::size_t x = 0; x < size; ++x)
        result[x] = interpolated(line, (static_cast<double>(x) + 0.5) / block);
    return result;
}

/// Twice as fine: each coarse texel spreads by a `kernel` of six weights, of which every second meets a finer texel.
/// The two largest of those three are taken as a pair.
Line smoothed_line(const Line& line, std::size_t size, double extent, const Line& kernel) {
    Line result(size);
    for (std::size_t x = 0; x < size; ++x) {
        const std::size_t coarse = x / 2;
        const double nearest = static_cast<double>(coarse) + 0.5, side = x % 2 == 0 ? -1 : 1;
        const double pair = kernel[1] + kernel[2];
        result[x] = pair * mirrored(line, extent, nearest + side * kernel[1] / pair)
                    + kernel[0] * mirrored(line, extent, nearest - side);
    }
    return result;
}

using Change = std::function<Line(const Line&, bool is_row)>;

/// Apply `change` to every row, then to every column, of every channel.
Image64 separably(const Image64& image, int width, int height, const Change& change) {
    Image64 wide(width, image.height, 3);
    Image64 result(width, height, 3);
    for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < image.height; ++y) {
            Line row(static_cast<std::size_t>(image.width));
            for (int x = 0; x < image.width; ++x)
                row[static_cast<std::size_t>(x)] = image.at(x, y, c);
            row = change(row, true);
            for (int x = 0; x < width; ++x)
                wide.at(x, y, c) = row[static_cast<std::size_t>(x)];
        }
        for (int x = 0; x < width; ++x) {
            Line column(static_cast<std::size_t>(image.height));
            for (int y = 0; y < image.height; ++y)
                column[static_cast<std::size_t>(y)] = wide.at(x, y, c);
            column = change(column, false);
            for (int y = 0; y < height; ++y)
                result.at(x, y, c) = column[static_cast<std::size_t>(y)];
        }
    }
    return result;
}

double brightness(const Image64& image, int x, int y) {
    return std::max({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
}

/// The source of the glow at its own size, before anything is taken from it.
class Source {
public:
    explicit Source(const ReferenceInput& input) : input_(input) {
        image_ = input.value("mode") == emission ? input.attachments.at("emission") : input.color;
        repaired_ = Image64(image_.width, image_.height, 3);
        for (int y = 0; y < image_.height; ++y) {
            for (int x = 0; x < image_.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    const double value = image_.at(x, y, c);
                    repaired_.at(x, y, c) = std::isnan(value) ? 0 : std::clamp(value, -brightest, brightest);
                }
            }
        }
        if (input.value("firefly_guard") > 0) guard();
    }

    Image64 light() const {
        Image64 result = repaired_;
        for (int y = 0; y < result.height; ++y) {
            for (int x = 0; x < result.width; ++x)
                let_glow(result, x, y);
        }
        return result;
    }

    /// `low` takes the light of weighted means of 2x2 pixels, where all that it sees is light.
    Image64 quarter() const {
        const bool guarded = input_.value("firefly_guard") > 0;
        const Image64 from = guarded ? light() : image_;
        Image64 result((image_.width + 3) / 4, (image_.height + 3) / 4, 3);
        for (int y = 0; y < result.height; ++y) {
            for (int x = 0; x < result.width; ++x) {
                if (guarded || sees_light(x, y)) {
                    add_means(result, x, y, from);
                } else {
                    add_pixels(result, x, y);
                }
            }
        }
        return result;
    }

private:
    struct Pair {
        long first; ///< pixel from the block's first one on
        double weight, share_of_second;
    };
    static constexpr Pair pairs[] = {{-1, 0.25, 0.625}, {1, 0.5, 0.5}, {3, 0.25, 0.375}};

    static double mirrored_at(const Image64& image, long x, long y, int c) {
        const auto fold = [](long i, long size) {
            i = (i % (2 * size) + 2 * size) % (2 * size);
            return static_cast<int>(std::min(i, 2 * size - 1 - i));
        };
        return image.at(fold(x, image.width), fold(y, image.height), c);
    }
    /// Of 2x2 pixels.
    static double mean_at(const Image64& image, int x, int y, const Pair& row, const Pair& column, int c) {
        const long i = 4L * x + column.first, j = 4L * y + row.first;
        const double s = column.share_of_second, t = row.share_of_second;
        return (1 - t) * ((1 - s) * mirrored_at(image, i, j, c) + s * mirrored_at(image, i + 1, j, c))
               + t * ((1 - s) * mirrored_at(image, i, j + 1, c) + s * mirrored_at(image, i + 1, j + 1, c));
    }
    bool sees_light(int x, int y) const {
        for (const Pair& row : pairs) {
            for (const Pair& column : pairs) {
                for (int c = 0; c < 3; ++c) {
                    if (!(std::abs(mean_at(image_, x, y, row, column, c)) <= brightest)) return false;
                }
            }
        }
        return true;
    }
    void add_means(Image64& result, int x, int y, const Image64& from) const {
        for (const Pair& row : pairs) {
            for (const Pair& column : pairs) {
                Image64 mean(1, 1, 3);
                for (int c = 0; c < 3; ++c)
                    mean.at(0, 0, c) = mean_at(from, x, y, row, column, c);
                if (input_.value("firefly_guard") == 0) let_glow(mean, 0, 0);
                for (int c = 0; c < 3; ++c)
                    result.at(x, y, c) += row.weight * column.weight * mean.at(0, 0, c);
            }
        }
    }
    void add_pixels(Image64& result, int x, int y) const {
        for (int j = 4 * y; j < 4 * y + 4; ++j) {
            for (int i = 4 * x; i < 4 * x + 4; ++i) {
                Image64 pixel(1, 1, 3);
                for (int c = 0; c < 3; ++c) {
                    pixel.at(0, 0, c) =
                        repaired_.at(std::min(i, image_.width - 1), std::min(j, image_.height - 1), c);
                }
                let_glow(pixel, 0, 0);
                for (int c = 0; c < 3; ++c)
                    result.at(x, y, c) += pixel.at(0, 0, c) / 16;
            }
        }
    }
    /// In place: nothing below 0, and in threshold mode what is above the soft threshold.
    void let_glow(Image64& image, int x, int y) const {
        for (int c = 0; c < 3; ++c)
            image.at(x, y, c) = std::max(image.at(x, y, c), 0.0);
        if (input_.value("mode") != threshold) return;
        const double start = input_.value("threshold"), knee = start * input_.value("knee");
        const double brightest = brightness(image, x, y);
        double passed = std::max(brightest - start, 0.0);
        if (std::abs(brightest - start) < knee) passed = std::pow(brightest - start + knee, 2) / (4 * knee);
        for (int c = 0; c < 3; ++c)
            image.at(x, y, c) *= brightest > 0 ? passed / brightest : 0;
    }
    void guard() {
        const Image64 before = repaired_;
        for (int y = 0; y < image_.height; ++y) {
            for (int x = 0; x < image_.width; ++x) {
                double mean = 0;
                for (int i : {-1, 0, 1}) {
                    for (int j : {-1, 0, 1}) {
                        const int there_x = std::clamp(x + i, 0, image_.width - 1);
                        const int there_y = std::clamp(y + j, 0, image_.height - 1);
                        if (i != 0 || j != 0) mean += std::max(0.0, brightness(before, there_x, there_y)) / 8;
                    }
                }
                const double allowed = mean / input_.value("firefly_guard");
                const double own = brightness(before, x, y);
                for (int c = 0; c < 3; ++c)
                    repaired_.at(x, y, c) *= own > allowed ? allowed / own : 1;
            }
        }
    }

    const ReferenceInput& input_;
    Image64 image_, repaired_;
};

/// One blur: along lines at one size, or down to a coarser one and up again.
struct Blur {
    int size, coarser;
    Line line, down, up;
    double variance;
    long step = 1;
};

double variance_of(const Line& kernel) {
    double sum = 0, mean = 0, square = 0;
    for (std::size_t i = 0; i < kernel.size(); ++i) {
        sum += kernel[i];
        mean += static_cast<double>(i) * kernel[i];
        square += static_cast<double>(i * i) * kernel[i];
    }
    return square / sum - mean * mean / (sum * sum);
}

Line times(Line line, double factor) {
    for (double& value : line)
        value *= factor;
    return line;
}

/// Five weights of that variance, the outermost of which is given.
Line five(double variance, double outer) {
    const double inner = variance / 2 - 4 * outer;
    return {outer, inner, 1 - 2 * (inner + outer), inner, outer};
}

/// (1+z)^3 (1+z^2) / 16
const Line jimenez = {1 / 16.0, 3 / 16.0, 4 / 16.0, 4 / 16.0, 3 / 16.0, 1 / 16.0};

struct Pyramid {
    std::vector<Line> first, between;
    bool halves = true;
};

Pyramid pyramid_of(int level) {
    if (level == high) return {{binomial(2)}, {binomial(2)}};
    if (level == ultra) return {{five(0.25, 0), binomial(4)}, {binomial(4)}};
    if (level == best) {
        const Line eighth = five(0.125, 0.001953125), half = five(0.5, 0.0234375);
        return {{five(0.03125, 0), five(0.03125, 0), five(0.0625, 0.00048828125), eighth, eighth,
                 five(0.25, 0.0068359375), half, half, half},
                std::vector<Line>(4, binomial(4)),
                false};
    }
    return {};
}

Blur halving(int level, int size) {
    if (level == low && size == 0) {
        const Line down = {3 / 32.0, 5 / 32.0, 8 / 32.0, 8 / 32.0, 5 / 32.0, 3 / 32.0};
        const Line tent = {1 / 8.0, 3 / 8.0, 5 / 8.0, 7 / 8.0, 7 / 8.0, 5 / 8.0, 3 / 8.0, 1 / 8.0};
        return {0, 2, {}, down, tent, variance_of(down) + variance_of(tent)};
    }
    const Line down = level == medium && size == 0 ? binomial(3) : jimenez;
    const bool is_linear = size == 0 || (level == medium && size == 1);
    const Line up = times(is_linear ? binomial(3) : binomial(5), 2);
    return {size, size + 1, {}, down, up, (variance_of(down) + variance_of(up)) * std::pow(4, size)};
}

std::vector<Blur> blurs_of(int level, double widest, int longer_side) {
    const Pyramid pyramid = pyramid_of(level);
    std::vector<Blur> blurs;
    double sum = 0;
    const auto add = [&](const Blur& blur) {
        if (!blurs.empty() && sum >= widest) return;
        blurs.push_back(blur);
        sum += blur.variance;
    };
    for (const Line& line : pyramid.first)
        add({0, 0, line, {}, {}, variance_of(line)});
    int coarsest = level == low ? 2 : level == medium ? 1 : 0;
    while ((1 << coarsest) < longer_side)
        ++coarsest;
    for (int size = 0; size < coarsest && sum < widest; ++size) {
        if (pyramid.halves) {
            add(halving(level, size));
            if (blurs.back().coarser == 2 && size == 0) ++size;
        }
        const int line_size = pyramid.halves ? size + 1 : 0;
        for (const Line& line : pyramid.between) {
            add({line_size,
                 line_size,
                 line,
                 {},
                 {},
                 variance_of(line) * std::pow(4, pyramid.halves ? size + 1 : size),
                 pyramid.halves ? 1 : 1L << size});
        }
    }
    return blurs;
}

/// By quadrature: sqrt(sigma) is evenly distributed, and each sigma is shared by the two nearest blurs.
std::vector<double> shares_of(const std::vector<Blur>& blurs, double widest) {
    std::vector<double> shares(blurs.size() + 1, 0.0);
    constexpr int samples = 200000; // the shares' errors are some 1e-9
    for (int i = 0; i < samples; ++i) {
        const double variance = widest * std::pow((i + 0.5) / samples, 4);
        double below = 0;
        std::size_t node = 0;
        while (node < blurs.size() && below + blurs[node].variance <= variance)
            below += blurs[node++].variance;
        const double towards_next = node < blurs.size() ? (variance - below) / blurs[node].variance : 0;
        shares[node] += (1 - towards_next) / samples;
        if (node < blurs.size()) shares[node + 1] += towards_next / samples;
    }
    return shares;
}

/// The picture's side in texels of an image of that size.
double extent(const ReferenceInput& input, bool is_row, int size) {
    return (is_row ? input.color.width : input.color.height) / std::pow(2, size);
}

Image64 lines(const ReferenceInput& input, const Image64& image, const Blur& blur) {
    return separably(image, image.width, image.height, [&](const Line& line, bool is_row) {
        return spread(line, extent(input, is_row, blur.size), blur.line, static_cast<double>(blur.step));
    });
}

Image64 halved(const ReferenceInput& input, const Image64& image, const Blur& blur) {
    return separably(image, (image.width + 1) / 2, (image.height + 1) / 2,
                     [&](const Line& line, bool is_row) {
                         return halved(line, extent(input, is_row, blur.size), blur.down);
                     });
}

Image64 enlarged(const ReferenceInput& input, const Image64& image, const Image64& finer, const Blur& blur) {
    return separably(image, finer.width, finer.height, [&](const Line& line, bool is_row) {
        const auto size = static_cast<std::size_t>(is_row ? finer.width : finer.height);
        return blur.up.size() == 6 ? smoothed_line(line, size, extent(input, is_row, blur.coarser), blur.up)
                                   : interpolated_line(line, size, std::pow(2, blur.coarser - blur.size));
    });
}

/// The sum of all blurs. When light scatters, what stays in its pixel is the picture's own light.
Image64 glow_of(const ReferenceInput& input, int level) {
    const Source source(input);
    const double widest = 5 * std::pow(input.value("radius") * input.color.height, 2);
    const std::vector<Blur> blurs = blurs_of(level, widest, std::max(input.color.width, input.color.height));
    const std::vector<double> shares = shares_of(blurs, widest);
    std::vector<Image64> sizes = {source.light()};
    Image64 sum = input.value("mode") == scatter ? input.color : sizes[0];
    for (double& value : sum.values)
        value *= shares[0];
    for (const Blur& blur : blurs) {
        if (blur.coarser == blur.size) continue;
        const Image64 finer = sizes.back();
        const Image64 coarser = blur.coarser > blur.size + 1 ? source.quarter() : halved(input, finer, blur);
        sizes.resize(static_cast<std::size_t>(blur.coarser) + 1, finer);
        sizes.back() = coarser;
    }
    Image64 blurred = sizes[0];
    for (std::size_t node = 1; node <= blurs.size(); ++node) {
        const bool at_one_size = sizes.size() == 1; // blurs of one size may be done in any order
        if (!at_one_size) blurred = sizes[static_cast<std::size_t>(blurs[node - 1].coarser)];
        for (std::size_t i = node; i-- > (at_one_size ? node - 1 : 0);) {
            const Blur& blur = blurs[i];
            blurred = blur.size == blur.coarser
                          ? lines(input, blurred, blur)
                          : enlarged(input, blurred, sizes[static_cast<std::size_t>(blur.size)], blur);
        }
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += shares[node] * blurred.values[i];
    }
    return sum;
}

/// 21x21 texels, clamped at the border.
Image64 classic_glow_of(const ReferenceInput& input) {
    const Image64 light = Source(input).light();
    const long stride = std::max(1L, std::lround(input.value("radius") * light.height / 5));
    Line kernel(21);
    for (int i = 0; i < 21; ++i)
        kernel[static_cast<std::size_t>(i)] =
            std::exp(-std::pow(i - 10, 2) / 50) / (5 * std::sqrt(2 * std::numbers::pi));
    return separably(light, light.width, light.height, [&](const Line& line, bool) {
        Line result(line.size(), 0.0);
        const long last = static_cast<long>(line.size()) - 1;
        for (long x = 0; x <= last; ++x) {
            for (long k = 0; k < 21; ++k) {
                const long at = std::clamp(x + stride * (k - 10), 0L, last);
                result[static_cast<std::size_t>(x)] +=
                    kernel[static_cast<std::size_t>(k)] * line[static_cast<std::size_t>(at)];
            }
        }
        return result;
    });
}

} // namespace

Image64 postfx::testing::reference(const ReferenceInput& input) {
    const int level = input.level_among({"low", "medium", "high", "ultra", "reference", "classic"});
    const Image64 glow = level == classic ? classic_glow_of(input) : glow_of(input, level);
    const double intensity = input.value("radius") > 0 ? input.value("intensity") : 0; // neither: no glow
    Image64 result(glow.width, glow.height, 3);
    for (int y = 0; y < glow.height; ++y) {
        for (int x = 0; x < glow.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double tint = input.value("tint." + std::to_string(c));
                const double own = input.color.at(x, y, c);
                double added = intensity * tint * glow.at(x, y, c);
                if (input.value("mode") != scatter) {
                    result.at(x, y, c) = own + std::min(added, std::max(0.0, brightest - own));
                    continue;
                }
                result.at(x, y, c) = (1 - intensity) * own + added;
            }
        }
    }
    return result;
}
