// The eight orientations of EXIF, on the letter F, and what becomes of vectors.
#include <image/alpha.hpp>
#include <image/orientation.hpp>

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace postfx;

namespace {

/// Rows from the top, a pixel a letter.
Image picture_of(const std::vector<std::string>& rows) {
    Image image(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()), 1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.at(x, image.height - 1 - y, 0) =
                static_cast<float>(rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
    return image;
}

std::vector<std::string> rows_of(const Image& image) {
    std::vector<std::string> rows;
    for (int y = image.height - 1; y >= 0; --y) {
        rows.emplace_back();
        for (int x = 0; x < image.width; ++x)
            rows.back() += static_cast<char>(image.at(x, y, 0));
    }
    return rows;
}

} // namespace

TEST_CASE("All eight orientations show an upright F") {
    // What a sensor stores when the scene is an F; by the words of the standard, "row 0 is ..., column 0 is ...".
    const std::vector<std::vector<std::string>> stored = {
        {"FFF", "F..", "FF.", "F.."}, {"FFF", "..F", ".FF", "..F"}, {"..F", ".FF", "..F", "FFF"},
        {"F..", "FF.", "F..", "FFF"}, {"FFFF", "F.F.", "F..."},     {"F...", "F.F.", "FFFF"},
        {"...F", ".F.F", "FFFF"},     {"FFFF", ".F.F", "...F"}};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        CAPTURE(orientation);
        const Image turned =
            oriented(picture_of(stored[static_cast<std::size_t>(orientation - 1)]), orientation);
        CHECK(rows_of(turned) == stored[0]);
    }
}

TEST_CASE("Vectors of a normal map turn with it") {
    Image right(1, 1, 3); // x to the right
    right.values = {0.6f, 0.0f, 0.8f};
    const std::vector<std::vector<float>> expected = {{0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f},
                                                      {0.6f, 0, 0.8f}, {0, -0.6f, 0.8f}, {0, -0.6f, 0.8f},
                                                      {0, 0.6f, 0.8f}, {0, 0.6f, 0.8f}};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        CAPTURE(orientation);
        const auto& vector = expected[static_cast<std::size_t>(orientation - 1)];
        CHECK(oriented_normals(right, orientation, VectorCoding::as_they_are).values == vector);
        Image halves = right;
        for (float& value : halves.values)
            value = 0.5f + value / 2;
        const Image turned = oriented_normals(halves, orientation, VectorCoding::halves);
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(turned.values[i] == Approx(0.5 + vector[i] / 2));
    }
}

TEST_CASE("A map of the size that a photograph had before is turned with it") {
    CHECK(belonging_of(Image(4, 3, 1), 3, 4, 6) == Belonging::stored);
    CHECK(belonging_of(Image(3, 4, 1), 3, 4, 6) == Belonging::turned);
    CHECK(belonging_of(Image(4, 3, 1), 4, 3, 3) == Belonging::unknown);
    CHECK(belonging_of(Image(4, 4, 1), 4, 4, 6) == Belonging::unknown);
}

TEST_CASE("Straight and premultiplied alpha") {
    Image image(3, 1, 4);
    image.values = {0.5f, 0.25f, 0.5f, 0.5f, 2, 0, 0, 0, 1, 1, 1, 1};
    using Alpha = Coding::Alpha;
    // The flame, light without cover, stays.
    CHECK(with_alpha(image, Alpha::premultiplied, Alpha::straight).values
          == std::vector<float>{1, 0.5f, 1, 0.5f, 2, 0, 0, 0, 1, 1, 1, 1});
    CHECK(with_alpha(image, Alpha::straight, Alpha::premultiplied).values
          == std::vector<float>{0.25f, 0.125f, 0.25f, 0.5f, 0, 0, 0, 0, 1, 1, 1, 1});
    CHECK(with_alpha(image, Alpha::straight, Alpha::straight).values == image.values);
    CHECK(with_alpha(Image(1, 1, 3, 0.5f), Alpha::straight, Alpha::premultiplied).values
          == std::vector<float>(3, 0.5f));
}
