// Where truths sample.
#include <catch2/catch.hpp>

#include <truths/sampling.hpp>

#include <vector>

using namespace postfx::host;

TEST_CASE("sample points are spread evenly and differ between the halves") {
    constexpr int count = 256;
    std::vector<int> cells(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec2 p = sobol_point(i, 3);
        ++cells[static_cast<std::size_t>(p.x * 16) + 16 * static_cast<std::size_t>(p.y * 16)];
    }
    CHECK(cells == std::vector<int>(count, 1)); // a (0, 2)-sequence has one in each of 16 x 16 cells
    for (int i = 0; i < count; i += 2)
        CHECK(truth_point(i, 1) != truth_point(i + 1, 1));
    CHECK(glm::length(disc_point({0, 0})) == Approx(1));
    CHECK(disc_point({0.5, 0.5}) == glm::dvec2(0));
}
