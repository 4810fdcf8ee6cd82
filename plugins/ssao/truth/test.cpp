// Occlusion of height fields against closed forms.
#include <catch2/catch.hpp>

#include "height_field.hpp"

#include <cmath>
#include <functional>
#include <numbers>

using namespace postfx::host;
using postfx::Camera;
using postfx::Image;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double nowhere = std::numeric_limits<double>::infinity();

struct Seen {
    double z = nowhere; ///< metres along the view axis
    glm::dvec3 normal{0};
};
/// Of a line from the eye to 1 m along the view axis; parallel lines begin at its x and y.
using Surface = std::function<Seen(const glm::dvec3& line)>;

HeightField field(const Surface& surface, int width, int height, const Camera& camera, double radius,
                  double falloff) {
    Image depth(width, height, 1), normal(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto [right, up] = camera.view_plane(x + 0.5, y + 0.5, width, height);
            const Seen seen = surface({right, up, -1});
            depth.at(x, y, 0) = static_cast<float>(camera.depth_at(seen.z));
            for (int c = 0; c < 3; ++c)
                normal.at(x, y, c) = static_cast<float>(seen.normal[c]);
        }
    }
    return {depth, normal, camera, radius, falloff};
}

double visibility(const HeightField& field, int x, int y, int slices = 256) {
    double sum = 0;
    for (int i = 0; i < slices; ++i)
        sum += field.visibility(x, y, pi * (i + 0.5) / slices);
    return sum / slices;
}

const Camera perspective = Camera::perspective(50, 0.1);
const Camera parallel = Camera::parallel(4, 0.1, 100);

Surface plane(double distance, const glm::dvec3& normal) {
    return [=](const glm::dvec3& line) -> Seen {
        const double toward = -glm::dot(line, normal);
        return toward > 0 ? Seen{distance * normal.z / toward, normal} : Seen{};
    };
}

/// Of a floor at the distance d from an endless wall, by surfaces nearer than r.
double wall_occlusion(double d, double r) {
    const double k = std::min(d / r, 1.0);
    return (std::acos(k) - k * std::sqrt(1 - k * k)) / pi;
}

} // namespace

TEST_CASE("no part of a plane is occluded, however it is tilted") {
    for (const double degrees : {0, 30, 60, 80}) {
        for (const double distance : {0.5, 50.0}) {
            const double tilt = degrees * pi / 180;
            const glm::dvec3 normal(0.6 * std::sin(tilt), 0.8 * std::sin(tilt), std::cos(tilt));
            const HeightField tilted =
                field(plane(distance, normal), 48, 40, perspective, 0.3 * distance, 0.6);
            for (const int x : {0, 13, 24, 47}) {
                // Depth and normal are in float32: slopes of 1e-5 at most, of which the square is closed.
                INFO(degrees << " degrees, " << distance << " m, column " << x);
                CHECK(visibility(tilted, x, 20, 64) == Approx(1).margin(1e-7));
            }
        }
    }
}

TEST_CASE("a plane is one with a shifted lens too") {
    // At 60 degrees and seen from the side: with the axis in the middle it would be bent, and have corners.
    const double tilt = pi / 3;
    Camera camera = perspective;
    camera.principal_point = {1.4, 0.7};
    const Surface tilted = plane(5, {0.6 * std::sin(tilt), 0.8 * std::sin(tilt), std::cos(tilt)});
    const HeightField seen = field(tilted, 48, 40, camera, 1.5, 0.6);
    for (const int x : {0, 13, 24, 47})
        CHECK(visibility(seen, x, 20, 64) == Approx(1).margin(1e-7)); // as above
}

TEST_CASE("floor and wall hide each other by the closed form") {
    const double half = std::sqrt(0.5), radius = 0.8;
    constexpr int size = 160;
    const Surface corner = [&](const glm::dvec3& line) {
        const bool floor = line.y < 0;
        return Seen{5 / (1 + std::abs(line.y)), {0, floor ? half : -half, half}};
    };
    const HeightField seen = field(corner, size, size, perspective, radius, 0);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < size; ++y) {
        const double slope = (y + 0.5 - 0.5 * size) * 2 * perspective.tan_half_fov() / size;
        const double from_foot = std::abs(slope) * 5 / (1 + std::abs(slope)) / half;
        if (from_foot > 1.2 * radius) continue;
        // In the middle of the row: no wall is known beyond the border.
        const double error = 1 - visibility(seen, size / 2, y) - wall_occlusion(from_foot, radius);
        sum += error * error;
        ++count;
    }
    // A pixel is 0.03 m, 4 % of the radius, and the surface ends where the last pixel's middle is.
    INFO(std::sqrt(sum / count) << " over " << count << " rows");
    CHECK(count > 40);
    CHECK(std::sqrt(sum / count) < 0.006);
}

TEST_CASE("a falloff lifts the horizon by its share") {
    // A round wall of 1 m height at the distance d around a point: its upper rim is the horizon all around, the
    // nearest part of the wall its foot.
    constexpr int size = 201;
    const double d = 1;
    const Surface pit = [&](const glm::dvec3& line) {
        return Seen{std::hypot(line.x, line.y) < d ? 6.0 : 5.0, {0, 0, 1}};
    };
    for (const double radius : {1.6, 2.5, 100.0}) {
        const HeightField seen = field(pit, size, size, parallel, radius, 0.6);
        const double weight = std::min(1.0, (1 - std::sqrt(2) / radius) / 0.6);
        const double lifted = 1 - weight * (1 - std::sqrt(0.5)); // the cosine of its elevation
        // The rim's pixels begin up to a pixel, 2 %, farther out.
        CHECK(1 - visibility(seen, size / 2, size / 2) == Approx(1 - lifted * lifted).margin(0.02));
    }
}

TEST_CASE("everywhere in a spherical bowl the same share is hidden, half its depth over its radius") {
    for (const double depth : {0.3, 0.9}) {
        constexpr int size = 200;
        const double rim = std::sqrt(1 - (1 - depth) * (1 - depth));
        const Surface bowl = [&](const glm::dvec3& line) {
            const double from_middle = std::hypot(line.x, line.y);
            if (from_middle >= rim) return Seen{5, {0, 0, 1}};
            const double up = std::sqrt(1 - from_middle * from_middle); // under the sphere's centre
            return Seen{5 - (1 - depth) + up, {-line.x, -line.y, up}};
        };
        const HeightField seen = field(bowl, size, size, Camera::parallel(2.4, 0.1, 100), 100, 0);
        for (const double place : {0.0, 0.4, 0.8}) {
            const int x = static_cast<int>(size * (0.5 + place * rim / 2.4));
            INFO("depth " << depth << " at " << place << " of the rim");
            // The rim is known to a pixel, 1.2 % of the sphere's radius.
            CHECK(1 - visibility(seen, x, size / 2) == Approx(depth / 2).margin(0.012));
        }
    }
}

TEST_CASE("the middle of a pit sees what the closed form says") {
    for (const double depth : {0.25, 1.0}) {
        constexpr int size = 201;
        const Surface pit = [&](const glm::dvec3& line) {
            return Seen{std::hypot(line.x, line.y) < 0.5 ? 5 + depth : 5, {0, 0, 1}};
        };
        const HeightField seen = field(pit, size, size, Camera::parallel(2, 0.1, 100), 100, 0);
        INFO("depth " << depth);
        // The wall stands within a pixel of where it should, 2 % of the pit's radius.
        CHECK(visibility(seen, size / 2, size / 2) == Approx(0.25 / (0.25 + depth * depth)).margin(0.02));
    }
}

TEST_CASE("what has no surface or no normal is open, and what is convex hides nothing of itself") {
    const Surface ball = [](const glm::dvec3& line) -> Seen {
        const double a = glm::dot(line, line), b = -line.z * 5; // centre 5 m ahead, radius 1.5 m
        const double root = b * b - a * (25 - 1.5 * 1.5);
        if (root < 0) return {};
        const double z = (b - std::sqrt(root)) / a;
        return {z, (z * line - glm::dvec3(0, 0, -5)) / 1.5};
    };
    const HeightField seen = field(ball, 64, 64, perspective, 3, 0);
    for (int y = 0; y < 64; y += 3) {
        for (int x = 0; x < 64; x += 3)
            REQUIRE(visibility(seen, x, y, 32) == Approx(1).margin(1e-7)); // float32 again
    }
    Image depth(3, 3, 1, static_cast<float>(parallel.depth_at(5))), normal(3, 3, 3);
    depth.at(1, 1, 0) = static_cast<float>(parallel.depth_at(3));
    const HeightField flat(depth, normal, parallel, 10, 0);
    CHECK(flat.visibility(0, 0, 1) == 1);
}

TEST_CASE("a normal that looks away from the eye is turned until it does not") {
    Surface away = [](const glm::dvec3& line) {
        return Seen{4 + 0.3 * line.x * line.y, glm::normalize(glm::dvec3(line.x, 0.4, line.y - 0.5))};
    };
    for (const Camera& camera : {perspective, parallel}) {
        const HeightField seen = field(away, 60, 60, camera, 1, 0.6);
        for (int y = 0; y < 60; y += 3) {
            for (int x = 0; x < 60; x += 3) {
                const double found = visibility(seen, x, y, 64);
                REQUIRE(found >= 0);
                REQUIRE(found <= 1);
            }
        }
    }
}

TEST_CASE("a slice is the same from both of its ends") {
    const Surface step = [](const glm::dvec3& line) { return Seen{line.x < 0.1 ? 5.0 : 4.5, {0, 0, 1}}; };
    const HeightField seen = field(step, 80, 80, parallel, 2, 0.6);
    for (const double angle : {0.1, 1.0, 2.5}) {
        // Roundings of angles of some radians.
        CHECK(seen.visibility(38, 40, angle) == Approx(seen.visibility(38, 40, angle + pi)).margin(1e-12));
        CHECK(seen.visibility(38, 40, angle) < 0.95);
    }
}
