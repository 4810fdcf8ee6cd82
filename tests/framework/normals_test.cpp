// Normals that somebody else made, brought into view space.
#include <image/normals.hpp>

#include <postfx/error.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace postfx;

namespace {

using Vector = std::array<double, 3>;
constexpr int width = 64, height = 48;
constexpr Coding floats{};
constexpr Coding codes{.numbers = Coding::Numbers::codes, .bits = 8};
const Camera camera = Camera::perspective(50, 0.1);

/// Turned 30 degrees to the right and 20 down, and moved: world to camera.
RigidMatrix turned() {
    const double a = 0.5236, b = 0.3491, ca = std::cos(a), sa = std::sin(a), cb = std::cos(b),
                 sb = std::sin(b);
    return {ca, sa * sb, sa * cb, 0, 0, cb, -sb, 0, -sa, ca * sb, ca * cb, 0, 3, -2, 7, 1};
}

/// A floor, a ball on it and nothing above, in view space.
Image scene() {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double a = (x - 30) / 14.0, b = (y - 22) / 14.0, squared = a * a + b * b;
            Vector n{0, 0, 0};
            if (squared < 1)
                n = {a, b, std::sqrt(1 - squared)};
            else if (y < 24)
                n = {0, 0.8, 0.6};
            for (int c = 0; c < 3; ++c)
                image.at(x, y, c) = static_cast<float>(n[static_cast<std::size_t>(c)]);
        }
    }
    return image;
}

Image changed(const Image& image, const std::function<Vector(const Vector&)>& change) {
    Image result = image;
    for (std::size_t i = 0; i < image.values.size(); i += 3) {
        const Vector n = {image.values[i], image.values[i + 1], image.values[i + 2]};
        const Vector made = n == Vector{0, 0, 0} ? n : change(n);
        for (std::size_t c = 0; c < 3; ++c)
            result.values[i + c] = static_cast<float>(made[c]);
    }
    return result;
}

/// From view space into that camera's world.
Vector in_world(const Vector& n, const RigidMatrix& m) {
    return {m[0] * n[0] + m[1] * n[1] + m[2] * n[2], m[4] * n[0] + m[5] * n[1] + m[6] * n[2],
            m[8] * n[0] + m[9] * n[1] + m[10] * n[2]};
}

double worst_difference(const Image& a, const Image& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        worst = std::max(worst, static_cast<double>(std::abs(a.values[i] - b.values[i])));
    return worst;
}

std::string only_warning(const ViewNormals& normals) {
    REQUIRE(normals.warnings.size() == 1);
    return normals.warnings.front();
}

std::string refusal(const Image& image, const NormalSource& source) {
    try {
        view_normals(image, source, camera);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST_CASE("Unit normals in view space stay as they are, without a word") {
    const ViewNormals normals = view_normals(scene(), {}, camera);
    CHECK(normals.image.values == scene().values);
    CHECK(normals.warnings.empty());
    // So do a few shorter ones, which edges have.
    Image mixed = scene();
    for (int y = 0; y < 24; ++y)
        mixed.at(5, y, 1) = 0.3f;
    CHECK(view_normals(mixed, {}, camera).image.values == mixed.values);
    CHECK(view_normals(Image(8, 8, 3), {}, camera).warnings.empty());
}

TEST_CASE("Codes are decoded, black and grey are nothing") {
    Image encoded = changed(scene(), [](const Vector& n) -> Vector {
        return {std::round((n[0] + 1) * 127.5) / 255, std::round((n[1] + 1) * 127.5) / 255,
                std::round((n[2] + 1) * 127.5) / 255};
    });
    for (int c = 0; c < 3; ++c)
        encoded.at(0, height - 1, c) = 128 / 255.0f;
    const ViewNormals normals = view_normals(encoded, {.coding = codes}, camera);
    CHECK(worst_difference(normals.image, scene()) <= 1.001 / 255); // half a code of 2, and its rounding
    CHECK(normals.image.at(0, height - 1, 0) == 0);
    CHECK(normals.image.at(1, height - 1, 0) == 0);
    CHECK(normals.warnings.empty());
}

TEST_CASE("Floats that are encoded are told and decoded") {
    const Image encoded = changed(scene(), [](const Vector& n) -> Vector {
        return {0.5 + n[0] / 2, 0.5 + n[1] / 2, 0.5 + n[2] / 2};
    });
    const ViewNormals normals = view_normals(encoded, {.coding = floats}, camera);
    CHECK_THAT(only_warning(normals), Catch::Contains("0.5 + n / 2"));
    CHECK(worst_difference(normals.image, scene()) < 1e-6);
    // One surface whose normal has no negative component is no code.
    const Image corner = changed(scene(), [](const Vector&) -> Vector { return {0.6, 0, 0.8}; });
    CHECK(view_normals(corner, {}, camera).image.values == corner.values);
}

TEST_CASE("Lengths near 1 are made 1, others are refused") {
    for (const double scale : {0.7, 1.5}) {
        const Image scaled = changed(scene(), [&](const Vector& n) -> Vector {
            return {scale * n[0], scale * n[1], scale * n[2]};
        });
        const ViewNormals normals = view_normals(scaled, {}, camera);
        CHECK_THAT(only_warning(normals), Catch::Contains("lengths"));
        CHECK(worst_difference(normals.image, scene()) < 1e-6);
    }
    for (const double scale : {0.01, 0.4, 3.0, 255.0}) {
        const Image scaled = changed(scene(), [&](const Vector& n) -> Vector {
            return {scale * n[0], scale * n[1], scale * n[2]};
        });
        CHECK_THAT(refusal(scaled, {.name = "n.exr"}), Catch::StartsWith("n.exr: holds no normals"));
    }
    CHECK_THAT(refusal(Image(4, 4, 1), {}), Catch::Contains("a normal has three"));
}

TEST_CASE("Normals of world space are turned by the camera") {
    const Image world = changed(scene(), [](const Vector& n) { return in_world(n, turned()); });
    const ViewNormals normals =
        view_normals(world, {.space = NormalSpace::world, .world_to_camera = turned()}, camera);
    CHECK_THAT(only_warning(normals), Catch::Contains("world space"));
    CHECK(worst_difference(normals.image, scene()) < 1e-6);
    RigidMatrix centimetres = turned();
    for (std::size_t i = 0; i < 15; ++i)
        centimetres[i] *= i % 4 == 3 ? 1 : 0.01;
    const NormalSource scaled{.space = NormalSpace::world, .world_to_camera = centimetres};
    CHECK(worst_difference(view_normals(world, scaled, camera).image, scene()) < 1e-6);
    CHECK_THAT(refusal(world, {.space = NormalSpace::world}), Catch::Contains("--world-to-camera"));
}

TEST_CASE("Matrices that are no turn and move are refused with the reason") {
    const auto with = [](const std::function<void(RigidMatrix&)>& change) {
        RigidMatrix matrix = turned();
        change(matrix);
        return refusal(scene(), {.space = NormalSpace::world, .world_to_camera = matrix});
    };
    CHECK_THAT(with([](RigidMatrix& m) { m[5] = std::numeric_limits<double>::quiet_NaN(); }),
               Catch::Contains("nan"));
    CHECK_THAT(with([](RigidMatrix& m) { m[1] += 0.2; }), Catch::Contains("shears or stretches"));
    CHECK_THAT(with([](RigidMatrix& m) {
                   for (std::size_t i = 0; i < 3; ++i)
                       m[4 * i] *= 2;
               }),
               Catch::Contains("shears or stretches"));
    CHECK_THAT(with([](RigidMatrix& m) {
                   for (std::size_t i = 0; i < 3; ++i)
                       m[4 * i + 2] = -m[4 * i + 2];
               }),
               Catch::Contains("mirrors"));
    CHECK_THAT(with([](RigidMatrix& m) {
                   const RigidMatrix columns = m;
                   for (std::size_t i = 0; i < 16; ++i)
                       m[i] = columns[4 * (i % 4) + i / 4];
               }),
               Catch::Contains("row by row"));
    CHECK_THAT(with([](RigidMatrix& m) { m.fill(0); }), Catch::Contains("last row"));
}

TEST_CASE("Normals that look away from the camera are named") {
    const auto told = [](const std::function<Vector(const Vector&)>& change) {
        return only_warning(view_normals(changed(scene(), change), {}, camera));
    };
    CHECK_THAT(told([](const Vector& n) -> Vector {
                   return {-n[0], -n[1], -n[2]};
               }),
               Catch::Contains("--normal-space world"));
    CHECK_THAT(told([](const Vector& n) -> Vector {
                   return {n[0], n[1], -n[2]};
               }),
               Catch::Contains("look away"));
    // A camera that looks along the world's +z.
    const RigidMatrix back = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    CHECK_THAT(told([&](const Vector& n) { return in_world(n, back); }),
               Catch::Contains("--normal-space world"));
    // Turned by the wrong camera.
    const ViewNormals wrong =
        view_normals(scene(), {.space = NormalSpace::world, .world_to_camera = back}, camera);
    REQUIRE(wrong.warnings.size() == 2);
    CHECK_THAT(wrong.warnings.back(), Catch::Contains("does --world-to-camera belong"));
}
