// Cameras, and the projection matrices that others hand over.
#include <base/projection_matrix.hpp>

#include <postfx/error.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace postfx;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
using Kind = Camera::DepthKind;

/// glFrustum: left, right, bottom, top at the near plane.
ProjectionMatrix frustum(double left, double right, double bottom, double top, double near, double far) {
    return {2 * near / (right - left),
            0,
            0,
            0,
            0,
            2 * near / (top - bottom),
            0,
            0,
            (right + left) / (right - left),
            (top + bottom) / (top - bottom),
            -(far + near) / (far - near),
            -1,
            0,
            0,
            -2 * far * near / (far - near),
            0};
}

/// glOrtho.
ProjectionMatrix ortho(double left, double right, double bottom, double top, double near, double far) {
    return {2 / (right - left),
            0,
            0,
            0,
            0,
            2 / (top - bottom),
            0,
            0,
            0,
            0,
            -2 / (far - near),
            0,
            -(right + left) / (right - left),
            -(top + bottom) / (top - bottom),
            -(far + near) / (far - near),
            1};
}

/// Where a matrix shows a place of view space: x and y in -1..1, and OpenGL's window depth.
std::array<double, 3> shown(const ProjectionMatrix& m, double x, double y, double z) {
    std::array<double, 4> clip{};
    for (std::size_t row = 0; row < 4; ++row)
        clip[row] = m[row] * x + m[4 + row] * y - m[8 + row] * z + m[12 + row];
    return {clip[0] / clip[3], clip[1] / clip[3], (clip[2] / clip[3] + 1) / 2};
}

std::string refusal(const ProjectionMatrix& matrix, std::optional<Kind> kind = Kind::standard,
                    int width = 300, int height = 200) {
    try {
        camera_of(matrix, kind, width, height);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

const ProjectionMatrix plain = frustum(-0.15, 0.15, -0.1, 0.1, 0.1, 100);

} // namespace

TEST_CASE("a place in the picture looks where the projection shows it from") {
    // The same place by the matrix, and back by the camera: float64's rounding only.
    for (const auto& matrix :
         {plain, frustum(-0.05, 0.25, -0.15, 0.05, 0.1, 100), frustum(0.3, 0.6, -0.5, -0.3, 0.1, 9),
          ortho(-3, 3, -2, 2, 0.1, 100), ortho(-1, 5, -6, -2, 0, 50)}) {
        const Camera camera = camera_of(matrix, Kind::standard, 300, 200);
        for (const auto& [x, y, z] : {std::array{0.3, -0.2, 2.0}, std::array{-4.0, 1.0, 8.0}}) {
            const auto [across, up, depth] = shown(matrix, x, y, z);
            const auto [right, above] = camera.view_plane(150 * (across + 1), 100 * (up + 1), 300, 200);
            const double distance = camera.orthographic ? 1 : z;
            CHECK(right * distance == Approx(x).epsilon(1e-12));
            CHECK(above * distance == Approx(y).epsilon(1e-12));
            CHECK(camera.view_z(depth)
                  == Approx(z).epsilon(1e-9)); // 1 / z is a difference near the far plane
            CHECK(camera.depth_at(z) == Approx(depth).epsilon(1e-12));
        }
    }
}

TEST_CASE("a centred matrix is the camera of near, far and field of view") {
    const Camera read = camera_of(plain, Kind::standard, 300, 200);
    const Camera said = Camera::perspective(90, 0.1, 100, Kind::standard);
    CHECK(read.vertical_fov == Approx(said.vertical_fov).epsilon(1e-14));
    CHECK(read.depth_scale == Approx(said.depth_scale).epsilon(1e-14));
    CHECK(read.depth_offset == Approx(said.depth_offset).epsilon(1e-14));
    CHECK(read.near_plane == Approx(0.1).epsilon(1e-12));
    CHECK(read.far_plane == Approx(100).epsilon(1e-9));
    CHECK(read.sky_depth == 1);
    CHECK(read.principal_point == std::array<double, 2>{0, 0});
    CHECK_FALSE(std::signbit(read.principal_point[0]));
    ProjectionMatrix doubled = plain;
    for (double& entry : doubled)
        entry *= 2;
    CHECK(camera_of(doubled, Kind::standard, 300, 200).depth_scale == read.depth_scale);
}

TEST_CASE("reversed and infinite projections have clip depth 0 to 1") {
    const ProjectionMatrix reversed = {1, 0, 0, 0, 0, 1.5, 0, 0, 0.5, 0, 0.1 / 99.9, -1, 0, 0, 10 / 99.9, 0};
    const Camera camera = camera_of(reversed, Kind::reversed, 300, 200);
    CHECK(camera.near_plane == Approx(0.1));
    CHECK(camera.far_plane == Approx(100));
    CHECK(camera.principal_point[0] == -0.5);
    const ProjectionMatrix infinite = {1, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 0, -1, 0, 0, 0.25, 0};
    const Camera endless = camera_of(infinite, Kind::reversed_infinite, 300, 200);
    CHECK(endless.near_plane == 0.25);
    CHECK(endless.far_plane == infinity);
}

TEST_CASE("without a kind of depth the depth rows are not looked at") {
    ProjectionMatrix matrix = plain;
    matrix[10] = matrix[14] = 0;
    CHECK(camera_of(matrix, {}, 300, 200).vertical_fov == Approx(90));
    CHECK_THAT(refusal(matrix), Catch::Contains("no depth"));
}

TEST_CASE("matrices that make no sense are refused with the reason") {
    const auto with = [](std::size_t index, double value) {
        ProjectionMatrix matrix = plain;
        matrix[index] = value;
        return matrix;
    };
    CHECK_THAT(refusal(with(0, not_a_number)), Catch::Contains("nan"));
    CHECK_THAT(refusal(with(14, infinity)), Catch::Contains("inf"));
    CHECK_THAT(refusal(with(0, -plain[0])), Catch::Contains("mirrors the picture from left to right"));
    CHECK_THAT(refusal(with(5, -plain[5])), Catch::Contains("mirrors the picture upside down"));
    CHECK_THAT(refusal(with(0, 0)), Catch::Contains("shows nothing"));
    CHECK_THAT(refusal(with(1, 0.3)), Catch::Contains("turns or shears"));
    CHECK_THAT(refusal(with(12, 0.3)), Catch::Contains("turns or shears"));
    CHECK_THAT(refusal(with(2, 0.3)), Catch::Contains("oblique"));
    CHECK_THAT(refusal(with(11, 1)), Catch::Contains("looks along +z"));
    CHECK_THAT(refusal(with(11, 0)), Catch::Contains("last row"));
    CHECK_THAT(refusal(with(3, 0.5)), Catch::Contains("last row"));
    CHECK_THAT(refusal({}), Catch::Contains("last row"));
    CHECK_THAT(refusal(plain, Kind::standard, 100, 200), Catch::Contains("times as wide as high"));
    CHECK_THAT(refusal(plain, Kind::reversed), Catch::Contains("runs the other way"));
    CHECK_THAT(refusal(ortho(-3, 3, -2, 2, -1, 10)), Catch::Contains("near plane behind the camera"));
    CHECK_THAT(refusal(ortho(-3, 3, -2, 2, 10, 1)), Catch::Contains("runs the other way"));
    for (const ProjectionMatrix& matrix : {plain, ortho(-1, 5, -6, -2, 0.1, 50)}) {
        ProjectionMatrix rows{};
        for (std::size_t i = 0; i < 16; ++i)
            rows[i] = matrix[4 * (i % 4) + i / 4];
        CHECK_THAT(refusal(rows), Catch::Contains("row by row"));
    }
}
