#include <base/projection_matrix.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace postfx {
namespace {

/// What exporters that reckon in float32 leave of zeros, as a share of the largest entry.
constexpr double rounding = 1e-6;
/// Between the matrix's shape and that of pixels: sizes are rounded to whole pixels.
constexpr double shape_tolerance = 0.01;

class Reader {
public:
    Reader(const ProjectionMatrix& matrix, int width, int height)
        : matrix_(matrix), width_(width), height_(height) {
        check_numbers();
        parallel_ = is_zero(at(3, 2)) && !is_zero(at(3, 3));
        const double unit = parallel_ ? at(3, 3) : -at(3, 2);
        if (is_zero(unit))
            fail("has a last row that is neither 0 0 -1 0 (perspective) nor 0 0 0 1 (parallel)");
        check_order();
        if (unit < 0) {
            fail(parallel_
                     ? "has a negative last number"
                     : "looks along +z (its last row is 0 0 1 0, as in Direct3D); OpenGL's looks along -z");
        }
        for (double& entry : matrix_)
            entry /= unit;
        largest_ /= unit;
        check_axes();
    }

    Camera camera() const {
        Camera camera;
        camera.orthographic = parallel_;
        if (parallel_)
            camera.vertical_extent = 2 / at(1, 1);
        else
            camera.vertical_fov = 2 * std::atan(1 / at(1, 1)) * 180 / std::numbers::pi;
        // x_ndc = p00 x / z - p02 in perspective, p00 x + p03 in parallel.
        for (int axis = 0; axis < 2; ++axis) {
            const double of_axis = parallel_ ? at(axis, 3) : -at(axis, 2);
            camera.principal_point[static_cast<std::size_t>(axis)] = of_axis == 0 ? 0 : of_axis; // no -0
        }
        return camera;
    }

    void read_depth(Camera& camera, Camera::DepthKind kind) const {
        const bool standard = kind == Camera::DepthKind::standard;
        // A sample is clip depth itself where that is 0..1, else (clip depth + 1) / 2. Clip depth is -p22 + p23 / z in
        // perspective, -p22 z + p23 in parallel.
        const double clip_scale = standard ? 2 : 1, clip_offset = standard ? -1 : 0;
        const double divisor = parallel_ ? -at(2, 2) : at(2, 3);
        if (divisor == 0) fail("has no depth: all samples would be the same");
        camera.depth_scale = clip_scale / divisor;
        camera.depth_offset = (clip_offset + (parallel_ ? -at(2, 3) : at(2, 2))) / divisor;
        camera.sky_depth = standard ? 1 : 0;
        const auto affine = [&](double sample) { return camera.depth_scale * sample + camera.depth_offset; };
        const double at_near = affine(standard ? 0 : 1), at_far = affine(camera.sky_depth);
        if (parallel_ ? at_far <= at_near : at_near <= at_far) {
            fail(
                fmt::format("has depth that runs the other way: with this --depth-kind {} is far and {} near",
                            standard ? 0 : 1, camera.sky_depth));
        }
        camera.near_plane = parallel_ ? at_near : 1 / at_near;
        if (at_near < 0)
            fail(fmt::format("has its near plane behind the camera, at {:.6g} m", camera.near_plane));
        camera.far_plane = parallel_    ? at_far
                           : at_far > 0 ? 1 / at_far
                                        : std::numeric_limits<double>::infinity();
        // One that is infinite may be rounded to one behind the camera.
        if (!parallel_ && at_far < -rounding * at_near) {
            fail(fmt::format("has its far plane behind the camera, at {:.6g} m", 1 / at_far));
        }
    }

private:
    double at(int row, int column) const { return matrix_[static_cast<std::size_t>(4 * column + row)]; }
    bool is_zero(double entry) const { return std::abs(entry) <= rounding * largest_; }

    [[noreturn]] static void fail(const std::string& what) { throw Error("--projection " + what); }

    void check_numbers() {
        for (const double entry : matrix_) {
            if (!std::isfinite(entry)) fail(fmt::format("has the number {}", entry));
        }
        // Of what turns directions into places in the picture; near and far planes may be any size.
        largest_ = std::max({std::abs(at(0, 0)), std::abs(at(1, 1)), std::abs(at(3, 2)), std::abs(at(3, 3))});
    }

    void check_order() const {
        const bool as_columns = is_zero(at(3, 0)) && is_zero(at(3, 1)) && (parallel_ || is_zero(at(3, 3)));
        const bool as_rows = is_zero(at(0, 3)) && is_zero(at(1, 3)) && at(2, 3) == -1 && at(3, 2) != -1;
        const bool parallel_as_rows =
            !as_columns && is_zero(at(0, 3)) && is_zero(at(1, 3)) && is_zero(at(2, 3)) && !is_zero(at(3, 3));
        if (as_rows || parallel_as_rows) fail("is written row by row; its numbers go column by column");
        if (!as_columns) fail("has a last row that is neither 0 0 -1 0 (perspective) nor 0 0 0 1 (parallel)");
    }

    void check_axes() const {
        for (int row = 0; row < 2; ++row) {
            const char* direction = row == 0 ? "from left to right" : "upside down";
            const double diagonal = at(row, row);
            if (is_zero(diagonal))
                fail(fmt::format("has 0 in row {0} and column {0}: it shows nothing", row));
            if (diagonal < 0) {
                fail(fmt::format(
                    "mirrors the picture {} ({:.6g} in row {} and column {}); turn the images and give "
                    "a matrix that does not",
                    direction, diagonal, row, row));
            }
            const double elsewhere = at(row, parallel_ ? 2 : 3);
            if (!is_zero(at(row, 1 - row)) || !is_zero(elsewhere)) {
                fail(fmt::format("turns or shears the picture (row {} has {:.6g}, {:.6g}, {:.6g}, {:.6g})",
                                 row, at(row, 0), at(row, 1), at(row, 2), at(row, 3)));
            }
        }
        if (!is_zero(at(2, 0)) || !is_zero(at(2, 1))) {
            fail("has an oblique near plane, through which depth is no distance along the view axis");
        }
        const double shape = at(1, 1) / at(0, 0), wanted = static_cast<double>(width_) / height_;
        if (std::abs(shape / wanted - 1) > shape_tolerance) {
            fail(fmt::format("is for a picture {:.4g} times as wide as high, this one is {:.4g}", shape,
                             wanted));
        }
    }

    ProjectionMatrix matrix_;
    int width_, height_;
    bool parallel_ = false;
    double largest_ = 0;
};

} // namespace

Camera camera_of(const ProjectionMatrix& matrix, std::optional<Camera::DepthKind> kind, int width,
                 int height) {
    const Reader reader(matrix, width, height);
    Camera camera = reader.camera();
    if (kind) reader.read_depth(camera, *kind);
    return camera;
}

} // namespace postfx
