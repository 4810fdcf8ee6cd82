// Maps of fewer pixels brought to their picture's size along its edges.
#include <image/joint_bilateral.hpp>

#include <reduced_depth.hpp>
#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// A room of a floor, a wall, balls of many sizes and sky over the wall, each with a colour and a grain of its own, the
/// floor and the wall with tiles of two colours: edges of the picture that are none of the depth.
struct Room {
    Image picture, inverse_distance;

    Room(int width, int height) : picture(width, height, 3), inverse_distance(width, height, 1) {
        const Image grain = noise(width, height, 0.85f, 1.15f);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double right = (x + 0.5 - 0.5 * width) / height, up = (y + 0.5 - 0.5 * height) / height;
                float& nearest = inverse_distance.at(x, y, 0);
                std::array<float, 3> color = {0.3f, 0.5f, 0.9f};
                const auto see = [&](double inverse, const std::array<float, 3>& light) {
                    if (!(inverse > static_cast<double>(nearest))) return;
                    nearest = static_cast<float>(inverse);
                    color = light;
                };
                const bool tile =
                    (static_cast<int>(std::floor(8 * right)) + static_cast<int>(std::floor(8 * up))) % 2 != 0;
                if (up < 0.25)
                    see(1 / 9.0, tile ? std::array{0.5f, 0.4f, 0.3f} : std::array{0.4f, 0.3f, 0.2f});
                see(-up / 1.2, tile ? std::array{0.2f, 0.25f, 0.2f} : std::array{0.15f, 0.2f, 0.15f});
                for (int i = 0; i < 9; ++i) {
                    const double radius = 0.03 + 0.012 * i, distance = 2 + 0.6 * i;
                    const double a = right - 0.75 + 0.19 * i, b = up - 0.25 * std::sin(2.5 * i);
                    if (a * a + b * b < radius * radius)
                        see(1 / distance,
                            {0.9f - 0.08f * static_cast<float>(i), 0.1f, 0.05f * static_cast<float>(i)});
                }
                for (int c = 0; c < 3; ++c)
                    picture.at(x, y, c) = color[static_cast<std::size_t>(c)] * grain.at(x, y, c);
            }
        }
    }
};

} // namespace

TEST_CASE("A plane comes out exact, however coarse its map is") {
    for (const auto& [width, height] : {std::pair{24, 16}, std::pair{7, 5}, std::pair{2, 2}}) {
        Image values(width, height, 1);
        const auto plane = [](double x, double y) { return 1 + 0.02 * x + 0.01 * y; };
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                values.at(x, y, 0) = static_cast<float>(plane((x + 0.5) / width, (y + 0.5) / height));
        }
        const Image picture = noise(96, 64, 0, 1);
        const Image result = joint_bilateral(values, picture);
        double worst = 0;
        for (int y = 64 / height; y < 64 - 64 / height; ++y) {
            for (int x = 96 / width; x < 96 - 96 / width; ++x) {
                const double expected = plane((x + 0.5) / 96, (y + 0.5) / 64);
                worst = std::max(worst, std::abs(static_cast<double>(result.at(x, y, 0)) - expected));
            }
        }
        CHECK(worst < 1e-6); // a dozen roundings of numbers near 1
    }
}

TEST_CASE("Of two surfaces no value lies between, and the edge is the picture's") {
    constexpr int width = 128, height = 64, factor = 8;
    Image truth(width, height, 1), picture(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool near = x + y / 3 < 70; // a slanted edge, so that it lies anywhere between values
            truth.at(x, y, 0) = near ? 0.5f : 0.0f;
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, c) = near ? 0.6f : 0.2f;
        }
    }
    for (const float far : {0.0f, 0.1f, 0.3f}) {
        for (float& value : truth.values)
            value = value == 0.5f ? 0.5f : far;
        const Image result = joint_bilateral(nearest_values(truth, width / factor, height / factor), picture);
        std::set<float> found(result.values.begin(), result.values.end());
        CHECK(found == std::set<float>{far, 0.5f});
        CHECK(result.values == truth.values);
        for (float& value : truth.values)
            value = value == 0.5f ? 0.5f : 0.0f;
    }
}

TEST_CASE("Reduced 4 to 8 times, depth is nearer to the truth than by the nearest value or by four") {
    const Room room(480, 320);
    for (const int factor : {4, 5, 8}) {
        const Image reduced = nearest_values(room.inverse_distance, 480 / factor, 320 / factor);
        const DepthError joint = depth_error(joint_bilateral(reduced, room.picture), room.inverse_distance);
        const DepthError nearest = depth_error(nearest_values(reduced, 480, 320), room.inverse_distance);
        const DepthError bilinear = depth_error(bilinear_values(reduced, 480, 320), room.inverse_distance);
        INFO("reduced " << factor << " times: wrong " << joint.wrong << " nearest " << nearest.wrong
                        << " bilinear " << bilinear.wrong << "; nothing " << joint.nothing << ", "
                        << nearest.nothing << ", " << bilinear.nothing << "; mean " << joint.mean << ", "
                        << nearest.mean << ", " << bilinear.mean);
        // Errors lie along edges. Where colours tell the two sides apart, as they do here, most are gone: half is asked
        // for, since of balls of few values corners are missing whatever is done.
        CHECK(joint.wrong < 0.5 * nearest.wrong);
        CHECK(joint.wrong < 0.5 * bilinear.wrong);
        CHECK(joint.nothing < 0.5 * nearest.nothing);
        CHECK(joint.nothing < 0.5 * bilinear.nothing);
        CHECK(joint.mean < 0.5 * nearest.mean);
        CHECK(joint.mean < 0.5 * bilinear.mean);
    }
}

TEST_CASE("Guides that are not light, and maps of one value, do no harm") {
    Image picture = noise(33, 21, -5, 60);
    picture.at(3, 3, 0) = std::numeric_limits<float>::quiet_NaN();
    picture.at(9, 9, 1) = std::numeric_limits<float>::infinity();
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{3, 2}, std::pair{33, 21}}) {
        Image values(width, height, 1, 0.25f);
        if (width > 1) values.at(1, 1, 0) = 0;
        const Image result = joint_bilateral(values, picture);
        CHECK(std::all_of(result.values.begin(), result.values.end(),
                          [](float value) { return value == 0 || std::abs(value - 0.25f) < 1e-6f; }));
    }
    const Image grey = part_of(noise(33, 21, 0, 1), {0, 0, 33, 21});
    CHECK(joint_bilateral(Image(3, 2, 1), grey).values == std::vector<float>(33 * 21, 0.0f));
}
