// Tone curves against what is known of them.
#include <catch2/catch.hpp>

#include <truth_of.hpp>

#include <algorithm>

using postfx::Image64;
using postfx::host::TruthResult;
using postfx::testing::Numbers;
using postfx::testing::truth_of;

namespace {

double mapped(double light, const Numbers& values) {
    return truth_of("tonemap", "layer", Image64(2, 1, 3, light), values, 2).picture.values[0];
}

enum Operator { aces, reinhard, hable, clamped };

} // namespace

TEST_CASE("tone curves pass the points that they are made for") {
    for (const Operator curve : {aces, reinhard, hable, clamped}) {
        const Numbers values = {{"operator", curve}, {"white", 3}};
        CHECK(mapped(0, values) == 0);
        CHECK(mapped(-1, values) == 0);
        double before = 0;
        for (double light = 1e-4; light < 1e5; light *= 1.5) {
            const double now = mapped(light, values);
            CHECK(now >= before);
            CHECK(now <= 1);
            before = now;
        }
        CHECK(before > 0.99);
        Numbers brighter = values;
        brighter["exposure"] = 2;
        CHECK(mapped(0.05, brighter) == Approx(mapped(0.2, values)).epsilon(1e-14)); // roundings
    }
    // Reinhard's white comes out as 1, middle grey by the published curve.
    CHECK(mapped(3, {{"operator", reinhard}, {"white", 3}}) == Approx(1).margin(1e-14));
    CHECK(mapped(0.18, {{"operator", reinhard}, {"white", 1000}}) == Approx(0.18 / 1.18).epsilon(1e-6));
    CHECK(mapped(11.2 / 2, {{"operator", hable}}) == Approx(1).margin(1e-14)); // after its bias of 2
    CHECK(mapped(0.18, {{"operator", aces}}) == Approx(0.21).margin(0.005));
    CHECK(mapped(0.7, {{"operator", clamped}}) == 0.7);
}

TEST_CASE("reinhard's curve keeps hue and luminance, also where a channel does not fit") {
    const auto luminance = [](const double* c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
    Image64 light(3, 1, 3);
    light.values = {0.4, 0.2, 0.1, 0.1, 0.2, 8, 30, 1, 1};
    const TruthResult result = truth_of("tonemap", "layer", light, {{"operator", reinhard}, {"white", 4}}, 2);
    CHECK(result.own_error < 12 * 0x1p-53);
    for (int x = 0; x < 3; ++x) {
        const double before = luminance(light.pixel(x, 0));
        const double after = std::min(before * (1 + before / 16) / (1 + before), 1.0);
        CHECK(luminance(result.picture.pixel(x, 0)) == Approx(after).epsilon(1e-13)); // roundings
    }
    CHECK(result.picture.at(0, 0, 0) / result.picture.at(0, 0, 2) == Approx(4).epsilon(1e-13));
    CHECK(result.picture.at(1, 0, 2) == Approx(1).margin(1e-15));
}
