// The grain's model in float64. The hash is part of the model (C. Wellons 2018, "lowbias32", with a key
// between its two rounds) and is written down here a second time.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace postfx::testing {
namespace {

using Triple = std::array<double, 3>;
enum Level { classic, low, medium, high, boolean };

const double pi = std::acos(-1.0);

std::uint32_t folded(std::uint32_t word, int bits) {
    return word ^ (word >> bits);
}

std::uint32_t keyed(std::uint32_t word, std::uint32_t before, std::uint32_t between) {
    word = folded(word + before, 16) * 2146121005u;
    return folded((folded(word, 15) + between) * 2221713035u, 16);
}

std::uint32_t mixed(std::uint32_t word) {
    return keyed(word, 0, 0);
}

std::uint32_t key_of(const ReferenceInput& input) {
    const auto own_seed = static_cast<std::uint32_t>(input.value("seed"));
    return mixed(input.frame * 2654435769u + input.seed * 2246822507u + own_seed * 3266489909u);
}

std::uint32_t word_at(int x, int y, std::uint32_t key) {
    const std::uint32_t place = static_cast<std::uint32_t>(x) + 65536u * static_cast<std::uint32_t>(y);
    return keyed(place * 2654435769u, key, key);
}

/// Three numbers of 10 bits; mean 0, variance 1.
Triple numbers(std::uint32_t word) {
    Triple result;
    const std::uint32_t parts[] = {word % 1024, word / 1024 % 1024, word / (1u << 22)};
    for (std::size_t c = 0; c < 3; ++c)
        result[c] = std::sqrt(12.0) * ((parts[c] + 0.5) / 1024 - 0.5);
    return result;
}

/// A weighted sum whose weights are scaled to a root sum of squares of 1.
class Sum {
public:
    void add(const Triple& value, double weight) {
        for (std::size_t c = 0; c < 3; ++c)
            sum_[c] += weight * value[c];
        squares_ += weight * weight;
    }
    Triple normalised() const {
        const double scale = std::sqrt(squares_);
        return {sum_[0] / scale, sum_[1] / scale, sum_[2] / scale};
    }

private:
    Triple sum_{};
    double squares_ = 0;
};

/// A disc of that radius [px] through a pixel's square, as a disc with a slope instead of an edge.
struct SlopedDisc {
    double reach;
    double area = 0, area_of_square = 0; ///< integrals of its height and of its square

    explicit SlopedDisc(double radius) {
        const double x = 3 * radius * radius; // 1: where the slope meets in the middle
        reach = x > 1 ? 0.5 + std::sqrt((x - 0.25) / 3) : std::sqrt(5 / 9.0 + x * 4 / 9);
        constexpr int rings = 20000;
        for (int i = 0; i < rings; ++i) {
            const double r = reach * (i + 0.5) / rings, ring = 2 * pi * r * reach / rings;
            area += ring * height(r);
            area_of_square += ring * std::pow(height(r), 2);
        }
    }
    double height(double distance) const { return std::clamp(reach - distance, 0.0, 1.0); }
};

/// The last one asked for is kept: its integrals take longer than a pixel.
const SlopedDisc& seen_disc(double radius) {
    static double known = -1;
    static SlopedDisc disc(1);
    if (known != radius) disc = SlopedDisc(known = radius);
    return disc;
}

/// Corner (i, j) of the triangular lattice with edges of length `edge` stands at i * a + j * b, where a and b
/// are the edges that lie symmetrically about the diagonal.
Triple triangular_field(double x, double y, double edge, std::uint32_t key) {
    const double ax = edge * std::cos(pi / 12), ay = -edge * std::sin(pi / 12);
    const double bx = -edge * std::sin(pi / 12), by = edge * std::cos(pi / 12);
    const double reach = edge * std::sqrt(3.0) / 2; // height of a triangle
    const double determinant = ax * by - ay * bx;
    const auto i0 = static_cast<int>(std::floor((x * by - y * bx) / determinant));
    const auto j0 = static_cast<int>(std::floor((y * ax - x * ay) / determinant));
    Sum sum;
    for (int j = j0 - 1; j <= j0 + 2; ++j) {
        for (int i = i0 - 1; i <= i0 + 2; ++i) {
            const double dx = x - (i * ax + j * bx), dy = y - (i * ay + j * by);
            const double inside = 1 - (dx * dx + dy * dy) / (reach * reach);
            if (inside > 0) sum.add(numbers(word_at(i, j, key)), inside * inside);
        }
    }
    return sum.normalised();
}

/// Points of a square lattice with `edge` [px]: the black ones within the reach of a disc, the white ones within that of
/// a smaller one, more of them the lighter it is.
Triple square_field(double x, double y, double edge, double radius, const Triple& light, std::uint32_t key) {
    const auto i0 = static_cast<int>(std::floor(x / edge)), j0 = static_cast<int>(std::floor(y / edge));
    Triple result;
    for (std::size_t c = 0; c < 3; ++c) {
        const double bare = std::pow(std::clamp(1 - light[c], 0.02, 1.0), 0.2);
        const double x3 = 1.5 * radius * radius * bare;
        const double smaller = x3 > 1 ? 0.5 + std::sqrt((x3 - 0.25) / 3) : std::sqrt(5 / 9.0 + x3 * 4 / 9);
        Sum discs, gaps;
        for (int j = j0 - 2; j <= j0 + 3; ++j) {
            for (int i = i0 - 2; i <= i0 + 3; ++i) {
                const bool black = (i + j) % 2 == 0;
                const double distance = std::hypot(x - i * edge, y - j * edge);
                const double weight = std::clamp((black ? 2 * edge : smaller) - distance, 0.0, 1.0);
                if (weight > 0) (black ? discs : gaps).add(numbers(word_at(i + 1, j + 1, key)), weight);
            }
        }
        result[c] = bare * discs.normalised()[c] + std::sqrt(1 - bare * bare) * gaps.normalised()[c];
    }
    return result;
}

/// How many of a Poisson process's points a uniform number stands for: more than n where it is below the probability
/// of that.
int poisson(double number, double mean) {
    int count = 0;
    double share = std::exp(-mean);
    for (double more = -std::expm1(-mean); number < more && count < 96; more -= share)
        share *= mean / ++count;
    return count;
}

/// What discs at random leave bare of a pixel. Places in cells, `cell` pixels wide.
double bare_share(double x, double y, double cell, const SlopedDisc& disc, double mean, std::uint32_t key) {
    double bare = 1;
    for (int j = static_cast<int>(std::floor(y)) - 1; j <= std::floor(y) + 1; ++j) {
        for (int i = static_cast<int>(std::floor(x)) - 1; i <= std::floor(x) + 1; ++i) {
            std::uint32_t word = word_at(i + 1, j + 1, key);
            const int count = poisson((word >> 8) / 16777216.0, mean);
            for (int k = 0; k < count; ++k) {
                word = mixed(word + 2654435769u);
                const double dx = i + (word % 65536 + 0.5) / 65536 - x;
                const double dy = j + ((word >> 16) + 0.5) / 65536 - y;
                bare *= 1 - disc.height(cell * std::hypot(dx, dy));
            }
        }
    }
    return bare;
}

/// The mean of `count` layers of discs.
double mean_cover(double x, double y, const SlopedDisc& disc, double mean, std::uint32_t key, int count) {
    const double cell = 2 * disc.reach;
    double sum = 0;
    for (int layer = 0; layer < count; ++layer) {
        key = mixed(key + 2654435769u);
        sum += 1 - bare_share(x / cell, y / cell, cell, disc, mean, key);
    }
    return count > 0 ? sum / count : 0;
}

/// Light mixed with the cover of layers that have its mean, some of them the channel's own. `sigma` is the deviation
/// asked for, over sqrt(u (1 - u)).
double boolean_light(double x, double y, const SlopedDisc& disc, double light, double sigma, double color,
                     std::uint32_t key, std::uint32_t channel) {
    if (!(light > 0 && light < 1)) return light;
    const double square = disc.area_of_square / disc.area;
    const auto variance = [&](double u) { return std::pow(1 - u, 2 - square) - std::pow(1 - u, 2); };
    const double fitting = std::floor(4 * variance(0.5) / (sigma * sigma));
    const int layers = static_cast<int>(std::clamp(fitting, 2.0, 32.0));
    int own = static_cast<int>(std::lround(color * layers));
    if (color > 0 && color < 1) own = std::clamp(own, 1, layers - 1);
    // Of the variance, common layers have 1 - color, though their number is not quite that part of all.
    double common_part = std::sqrt((1 - color) * (layers - own)), own_part = std::sqrt(color * own);
    const double parts = common_part + own_part;
    common_part /= parts;
    own_part /= parts;

    const double u = std::clamp(light, 1 / 8192.0, 0.999);
    const double mean = -std::log1p(-u) / disc.area * std::pow(2 * disc.reach, 2); // in a cell
    const double covered = common_part * mean_cover(x, y, disc, mean, key, layers - own)
                           + own_part * mean_cover(x, y, disc, mean, mixed(key + channel + 1), own);
    const double wanted = sigma * std::sqrt(u * (1 - u)), given = std::sqrt(variance(u)) / parts;
    const double dimmed = std::min({1.0, light / u, (1 - light) / (1 - u)});
    return light + dimmed * std::min(1.0, wanted / given) * (covered - u);
}

Triple field_at(const ReferenceInput& input, int level, int x, int y) {
    const double size = input.value("size") * input.color.height, px = x + 0.5, py = y + 0.5;
    const double radius = 0.875 * size;
    const std::uint32_t key = key_of(input);
    if (level == low) return numbers(word_at(x, y, key));
    // The square's 1 / 12 is that of a disc of diameter 2 / sqrt(3).
    if (level == medium)
        return triangular_field(px, py, 1.22 / 1.75 * std::hypot(2 * radius, 2 / std::sqrt(3.0)), key);
    Triple light;
    for (std::size_t c = 0; c < 3; ++c)
        light[c] = input.color.at(x, y, static_cast<int>(c));
    return square_field(px, py, seen_disc(radius).reach / 2, radius, light, key);
}

/// With a focus that is not known.
double sine_noise(const ReferenceInput& input, int x, int y) {
    const double u = (x + 0.5) / input.color.width + input.time,
                 v = (y + 0.5) / input.color.height + input.time;
    const double wave = std::sin(u * 12.9898 + v * 78.233) * 43758.5453;
    return input.value("amount") * std::sqrt(3.0) * (wave - std::floor(wave) - 0.5);
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const int width = input.color.width, height = input.color.height;
    const int level = input.level_among({"classic", "low", "medium", "high", "reference"});
    const double amount = input.value("amount") * std::min(input.value("size") * height, 1.0);
    const double own = std::sqrt(input.value("color"));
    const double joint = (std::sqrt(3 - 2 * input.value("color")) - own) / 3;
    Image64 result(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool is_summed = level == low || level == medium || level == high;
            const Triple field = is_summed ? field_at(input, level, x, y) : Triple{};
            const double all = field[0] + field[1] + field[2];
            for (int c = 0; c < 3; ++c) {
                const double u = input.color.at(x, y, c);
                if (level == classic) {
                    result.at(x, y, c) = u + sine_noise(input, x, y);
                    continue;
                }
                if (level == boolean) {
                    const SlopedDisc& disc = seen_disc(0.875 * input.value("size") * height);
                    result.at(x, y, c) =
                        boolean_light(x + 0.5, y + 0.5, disc, u, amount, input.value("color"), key_of(input),
                                      static_cast<std::uint32_t>(c));
                    continue;
                }
                const double room = std::max(0.0, std::min(u, 1 - u));
                const double noise = amount * std::sqrt(std::max(0.0, u * (1 - u)))
                                     * (own * field[static_cast<std::size_t>(c)] + joint * all);
                result.at(x, y, c) = u + std::clamp(noise, -room, room);
            }
        }
    }
    return result;
}

} // namespace postfx::testing
