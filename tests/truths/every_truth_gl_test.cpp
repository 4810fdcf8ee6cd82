// What holds for every truth of every effect of the tree: its own error, stopping and going on.
#include <catch2/catch.hpp>

#include "truth_of.hpp"

#include <temporary_directory.hpp>

#include <cmath>

using namespace postfx::host;
using namespace postfx::testing;
using postfx::Image64;

namespace {

/// Something near, in focus and far, in two colours, with edges.
const std::string room = R"(
camera: {position: [0, 1, 3], look_at: [0, 0.5, 0], vertical_fov: 45, near: 0.1, focus_distance: 3}
ambient: {above: [0.4, 0.5, 0.6], below: [0.3, 0.2, 0.1]}
materials:
  white: {diffuse: 1, specular: 0}
  lamp: {diffuse: 0.5, specular: 0, emission: [3, 2, 1]}
nodes:
  - {position: [0, 0, 0], mesh: {plane: {size: [8, 8]}}, material: white}
  - {position: [0, 0.3, 0], mesh: {box: {size: [0.6, 0.6, 0.6]}}, material: white}
  - {position: [0.6, 0.8, 1.5], mesh: {sphere: {radius: 0.2}}, material: lamp}
  - {position: [-1, 0.6, -2], mesh: {sphere: {radius: 0.5}}, material: lamp}
)";

} // namespace

TEST_CASE("every truth knows its own error, which falls as it should") {
    for (const RegisteredTruth& registered : registered_truths()) {
        INFO(registered.effect << " " << registered.kind);
        const TruthRequest asked = request_of(registered.effect, room, 40);
        if (registered.samples == 2) {
            // Reckoned in two ways, which do not sample: only rounding and steps are between them.
            CHECK(truth_of(asked, registered.kind, 2).own_error < 1e-9);
            continue;
        }
        const TruthResult little = truth_of(asked, registered.kind, 32),
                          more = truth_of(asked, registered.kind, 128),
                          much = truth_of(asked, registered.kind, 2048);
        INFO("own error " << little.own_error << " with 32, " << more.own_error << " with 128, "
                          << much.own_error << " with 2048 samples");
        CHECK(more.own_error > 0);
        // 4 times the samples: half the error of random ones. A tenth more for the error's own error.
        CHECK(more.own_error < 0.55 * little.own_error);
        CHECK(much.own_error < 0.275 * more.own_error);
        // The claim against what a much better one says.
        const double error = root_mean_square_difference(more.picture, much.picture) / much.root_mean_square;
        CHECK(more.own_error > 0.7 * error);
        CHECK(more.own_error < 1.5 * error);
    }
}

TEST_CASE("every truth goes on where it was stopped, to the same bits") {
    const TemporaryDirectory folder;
    for (const RegisteredTruth& registered : registered_truths()) {
        INFO(registered.effect << " " << registered.kind);
        const TruthRequest asked = request_of(registered.effect, room, 16);
        const TruthResult whole = truth_of(asked, registered.kind, 16);

        TruthRun first(registered, asked, 16);
        const auto file = folder / first.file_name();
        CHECK_FALSE(first.resume(file));
        while (first.done() < 7)
            first.step();
        first.save(file);

        TruthRun second(registered, asked, 16);
        REQUIRE(second.file_name() == first.file_name());
        REQUIRE(second.resume(file));
        CHECK(second.done() == 7);
        while (!second.complete())
            second.step();
        CHECK(second.result().picture.values == whole.picture.values);
        CHECK(second.result().own_error == whole.own_error);
    }
}
