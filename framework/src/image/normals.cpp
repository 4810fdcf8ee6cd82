#include <image/normals.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Vector& a) {
    return std::sqrt(dot(a, a));
}

/// Shorter than this is what codes leave of 0, and no direction.
constexpr double nothing_of_codes = 0.1;
/// Of a length, from 1: what codes of 8 bits, half floats and compression leave.
constexpr double length_tolerance = 0.1;
/// A share of the pixels that is more than edges, which are mixed of two normals.
constexpr double more_than_edges = 0.1;

Vector read(const Image& image, std::size_t pixel) {
    const float* n = &image.values[pixel * static_cast<std::size_t>(image.channels)];
    return {static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])};
}
void write(Image& image, std::size_t pixel, const Vector& n) {
    for (std::size_t c = 0; c < 3; ++c)
        image.values[3 * pixel + c] = static_cast<float>(n[c]);
}

Vector decoded(const Vector& n) {
    return {2 * n[0] - 1, 2 * n[1] - 1, 2 * n[2] - 1};
}

std::string per_cent(std::size_t part, std::size_t whole) {
    return fmt::format("{:.0f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// How long the vectors of an image are. Zero and what is not finite does not count.
struct Lengths {
    std::size_t count = 0, unit = 0, hopeless = 0;
    double shortest = HUGE_VAL, longest = 0;

    void add(double length) {
        if (!(length > 0) || !std::isfinite(length)) return;
        ++count;
        unit += std::abs(length - 1) <= length_tolerance;
        hopeless += length < 0.5 || length > 2;
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
    }
    bool mostly_unit() const {
        return static_cast<double>(count - unit) <= more_than_edges * static_cast<double>(count);
    }
};

Lengths lengths_of(const Image& image) {
    Lengths lengths;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        lengths.add(length(read(image, i)));
    return lengths;
}

/// Are floats codes, 0.5 + n / 2? None is negative then, few are of length 1, and nearly all are once decoded.
bool look_encoded(const Image& image) {
    Lengths raw, as_codes;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const Vector n = read(image, i);
        if (n[0] < 0 || n[1] < 0 || n[2] < 0) return false;
        const double decoded_length = length(decoded(n));
        if (!(length(n) > 0) || decoded_length < nothing_of_codes) continue;
        raw.add(length(n));
        as_codes.add(decoded_length);
    }
    return as_codes.count > 0 && as_codes.mostly_unit() && !raw.mostly_unit();
}

Image three_channels(const Image& normals) {
    Image result(normals.width, normals.height, 3);
    for (std::size_t i = 0; i < normals.pixel_count(); ++i)
        std::copy_n(&normals.values[i * static_cast<std::size_t>(normals.channels)], 3,
                    &result.values[3 * i]);
    return result;
}

void decode(Image& image) {
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const Vector stored = read(image, i), n = decoded(stored);
        const bool nothing = length(stored) == 0 || length(n) < nothing_of_codes;
        write(image, i, nothing ? Vector{0, 0, 0} : n);
    }
}

void make_unit(Image& image) {
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const Vector n = read(image, i);
        const double l = length(n);
        const bool usable = l > 0 && std::isfinite(l);
        write(image, i, usable ? Vector{n[0] / l, n[1] / l, n[2] / l} : Vector{0, 0, 0});
    }
}

/// The turn of a matrix that turns, moves and scales alike in all directions; rows.
std::array<Vector, 3> turn_of(const RigidMatrix& matrix) {
    const auto fail = [](const std::string& what) { throw Error("the matrix from world to camera " + what); };
    std::array<Vector, 3> rows{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
            rows[row][column] = matrix[4 * column + row];
    }
    for (const double entry : matrix) {
        if (!std::isfinite(entry)) fail(fmt::format("has the number {}", entry));
    }
    if (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1) {
        const bool as_rows = matrix[12] == 0 && matrix[13] == 0 && matrix[14] == 0 && matrix[15] == 1;
        fail(as_rows ? "is written row by row; its numbers go column by column"
                     : "has a last row that is not 0 0 0 1");
    }
    const double scale = length(rows[0]);
    if (scale == 0) fail("turns everything into nothing");
    for (Vector& row : rows) {
        for (double& entry : row)
            entry /= scale;
    }
    const Vector cross = {rows[0][1] * rows[1][2] - rows[0][2] * rows[1][1],
                          rows[0][2] * rows[1][0] - rows[0][0] * rows[1][2],
                          rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]};
    constexpr double rounding = 1e-3; // matrices are printed with few digits
    const double handedness = dot(cross, rows[2]);
    if (handedness < 0) fail("mirrors the world: the camera has x to the right, y up and looks along -z");
    if (std::abs(dot(rows[0], rows[1])) > rounding || std::abs(length(rows[1]) - 1) > rounding
        || std::abs(handedness - 1) > 3 * rounding) {
        fail("shears or stretches the world");
    }
    return rows;
}

void turn(Image& image, const RigidMatrix& world_to_camera) {
    const std::array<Vector, 3> rows = turn_of(world_to_camera);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const Vector n = read(image, i);
        write(image, i, {dot(rows[0], n), dot(rows[1], n), dot(rows[2], n)});
    }
}

/// How many of the surfaces look away from the eye by more than what smoothing does at outlines.
std::size_t looking_away(const Image& image, const Camera& camera) {
    std::size_t count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto [right, up] = camera.view_plane(x + 0.5, y + 0.5, image.width, image.height);
            const Vector eye = camera.orthographic ? Vector{0, 0, 1} : Vector{-right, -up, 1};
            const Vector n = read(image, static_cast<std::size_t>(y) * image.width + x);
            count += dot(n, eye) < -0.1 * length(n) * length(eye);
        }
    }
    return count;
}

} // namespace

ViewNormals view_normals(const Image& normals, const NormalSource& source, const Camera& camera) {
    const Place place{.file = source.name};
    if (normals.channels < 3)
        throw Error(place, fmt::format("has {} channels; a normal has three", normals.channels));
    ViewNormals result;
    result.image = three_channels(normals);
    if (source.coding.numbers == Coding::Numbers::codes) {
        decode(result.image);
    } else if (look_encoded(result.image)) {
        decode(result.image);
        result.warnings.emplace_back("holds 0.5 + n / 2 as floats: decoded");
    }
    const Lengths lengths = lengths_of(result.image);
    if (2 * lengths.hopeless > lengths.count) {
        throw Error(
            place,
            fmt::format("holds no normals: of its vectors that are not 0, {} are shorter than 0.5 or longer "
                        "than 2 (from {:.3g} to {:.3g})",
                        per_cent(lengths.hopeless, lengths.count), lengths.shortest, lengths.longest));
    }
    if (!lengths.mostly_unit()) {
        make_unit(result.image);
        result.warnings.push_back(fmt::format("has normals of lengths from {:.3g} to {:.3g}: made 1",
                                              lengths.shortest, lengths.longest));
    }
    if (source.space == NormalSpace::world) {
        if (!source.world_to_camera) {
            throw Error(
                place, "has normals of world space, which need the camera: --world-to-camera, or an EXR that "
                       "says worldToCamera");
        }
        turn(result.image, *source.world_to_camera);
        result.warnings.emplace_back("has normals of world space: turned into view space");
    }
    const std::size_t away = looking_away(result.image, camera);
    if (4 * away > lengths.count) {
        const bool was_world = source.space == NormalSpace::world;
        result.warnings.push_back(fmt::format(
            "{} of the normals look away from the camera, which no surface in view does: {}",
            per_cent(away, lengths.count),
            was_world
                ? "does --world-to-camera belong to this picture, and are its axes x right, y up, -z ahead?"
                : "are they of world space (--normal-space world), or have they y and z swapped or turned "
                  "round?"));
    }
    return result;
}

} // namespace postfx
