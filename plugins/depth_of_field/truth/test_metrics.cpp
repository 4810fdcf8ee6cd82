// Depth of field's metrics on functions of which it is known what they have to find.
#include <catch2/catch.hpp>

#include <effect_method.hpp>

using postfx::ChainEntry;
using postfx::Image64;
using postfx::host::MethodInput;
using namespace postfx::testing;

namespace {

/// 31 pixels of a line, mean.
Image64 smeared(const ChainEntry&, const MethodInput& input) {
    constexpr int reach = 15;
    Image64 picture(input.color.width, input.color.height, 3);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            for (int i = -reach; i <= reach; ++i) {
                const int from = std::clamp(x + i, 0, picture.width - 1);
                for (int c = 0; c < 3; ++c)
                    picture.at(x, y, c) += static_cast<double>(input.color.at(from, y, c)) / (2 * reach + 1);
            }
        }
    }
    return picture;
}

} // namespace

TEST_CASE("a lens that blurs without looking at depth leaks") {
    const FunctionMethod none("depth_of_field", unchanged);
    CHECK(measure("leakage", none) == 0);
    CHECK(measure("energy", none) == 0);
    const FunctionMethod blur("depth_of_field", smeared);
    // Of 31 pixels' mean, beyond an edge: 15/31, 14/31, ... over the 21 pixels of the largest circle.
    CHECK(measure("leakage", blur) == Approx(120.0 / 31 / 21).epsilon(1e-9));
    CHECK(measure("energy", blur) < 1e-12);
    const FunctionMethod dark("depth_of_field",
                              [](const ChainEntry&, const MethodInput& input) { return dimmed(input, 0); });
    CHECK(measure("energy", dark) == Approx(0.01).epsilon(1e-9));
}
