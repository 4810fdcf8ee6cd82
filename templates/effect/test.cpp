// my_effect against its reference, at its identity, and on pixels that should not be there.
#include <testing.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::testing;

namespace {

Input input_of(const Image& color) {
    Input input;
    input.color = color;
    return input;
}

} // namespace

TEST_CASE("my_effect agrees with its reference") {
    const double amount = GENERATE(0.25, 1.0);
    const Input input = input_of(noise(61, 37, 0.0f, 4.0f));
    const Values values = {{"amount", amount}, {"tint.0", 0.2}, {"tint.1", 0.9}, {"tint.2", 0.6}};
    const Image64 expected = reference(reference_input("my_effect", input, values));
    const Worst worst = worst_difference(run_effect("my_effect", input, values), expected);
    INFO("at " << worst.x << ", " << worst.y << " channel " << worst.channel);
    // Fewer than 8 float32 roundings of numbers up to 4, each at most 2^-24 of the number.
    CHECK(worst.absolute < 8 * 4 * 0x1p-24);
}

TEST_CASE("my_effect at its identity changes no bit") {
    const Input input = input_of(noise(16, 9, -1.0f, 70000.0f));
    CHECK(same_bits(run_effect("my_effect", input, {{"amount", 0}}), input.color));
}

TEST_CASE("my_effect keeps finite pixels finite") {
    const float value = GENERATE(0.0f, -0.5f, 1e-42f, 65504.0f, -65504.0f);
    const double amount = GENERATE(0.5, 1.0);
    const Image result =
        run_effect("my_effect", input_of(constant(5, 3, {value, 0.25f, value})), {{"amount", amount}});
    for (float channel : result.values)
        CHECK(std::isfinite(channel));
}

TEST_CASE("my_effect does not spread a pixel that is not finite") {
    const float value =
        GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
    const Input clean = input_of(noise(8, 8, 0.0f, 1.0f));
    Input hostile = clean;
    hostile.color.at(3, 4, 1) = value;
    const Image expected = run_effect("my_effect", clean);
    Image result = run_effect("my_effect", hostile);
    for (int c = 0; c < 3; ++c)
        result.at(3, 4, c) = expected.at(3, 4, c);
    CHECK(same_bits(result, expected));
}
