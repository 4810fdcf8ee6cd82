// Samples and numbers that somebody wrote down for them.
#include <image/matches_sample.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace postfx;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr Coding single{.numbers = Coding::Numbers::single, .bits = 32};
constexpr Coding half{.numbers = Coding::Numbers::half, .bits = 16};

constexpr Coding codes(int bits) {
    return {.numbers = Coding::Numbers::codes, .bits = bits};
}

} // namespace

TEST_CASE("Floats match what they are nearest to") {
    for (const double wanted : {1e12, 1e30, 999.9, 0.1, -1.0, 1e10, 16777217.0})
        CHECK(matches_sample(wanted, static_cast<float>(wanted), single));
    CHECK_FALSE(matches_sample(999.9, 999.8999f, single));
    CHECK_FALSE(matches_sample(1e30, infinity, single));
    CHECK(matches_sample(0, -0.0f, single));
    CHECK(matches_sample(std::numeric_limits<double>::infinity(), infinity, single));
}

TEST_CASE("Half floats match what they are nearest to, infinity beyond the largest") {
    CHECK(matches_sample(65504, 65504.0f, half));
    CHECK(matches_sample(1e30, infinity, half));
    CHECK(matches_sample(65520, infinity, half)); // rounds up, to even
    CHECK(matches_sample(999.9, 1000.0f, half));
    CHECK_FALSE(matches_sample(999.9, 999.5f, half));
    CHECK(matches_sample(-1e9, -infinity, half));
}

TEST_CASE("Codes match what they are nearest to") {
    for (const int bits : {8, 16}) {
        const double largest = bits == 8 ? 255 : 65535;
        CHECK(matches_sample(1, 1.0f, codes(bits)));
        CHECK(matches_sample(0.5, static_cast<float>(std::round(largest / 2) / largest), codes(bits)));
        CHECK_FALSE(
            matches_sample(0.5, static_cast<float>(std::round(largest / 2 + 1) / largest), codes(bits)));
        CHECK_FALSE(matches_sample(1, static_cast<float>((largest - 1) / largest), codes(bits)));
        for (int code = 0; code <= static_cast<int>(largest); ++code) {
            const auto read = static_cast<float>(code / largest);
            if (!matches_sample(code / largest, read, codes(bits))) FAIL("code " << code);
        }
    }
}

TEST_CASE("NaN matches NaN alone") {
    for (const Coding& coding : {single, half, codes(16)}) {
        CHECK(matches_sample(std::numeric_limits<double>::quiet_NaN(), not_a_number, coding));
        CHECK_FALSE(matches_sample(1, not_a_number, coding));
        CHECK_FALSE(matches_sample(std::numeric_limits<double>::quiet_NaN(), 1, coding));
    }
}
