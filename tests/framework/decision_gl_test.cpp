// What the frame decides: the picture is the one that all effects give, whatever was skipped, and the report says so.
#include <catch2/catch.hpp>

#include "execute_fixture.hpp"

#include <limits>
#include <random>

using namespace execute_fixture;
using postfx::Camera;
using postfx::EffectStatus;
using postfx::FrameInputs;
using postfx::PassReport;
using postfx::PlannedEffect;
using postfx::Report;
using postfx::Skip;
using postfx::testing::constant;
using postfx::testing::noise;
using postfx::testing::same_bits;

namespace {

struct Scene {
    Image color, depth;
};

/// Noise up to `brightest`; the nearest surface at `nearest` metres, or only sky.
Scene scene_of(float brightest, double nearest, int width = 67, int height = 41) {
    const Camera camera;
    Scene scene{noise(width, height, 0, brightest, 3), Image(width, height, 1)};
    scene.color.at(width / 2, height / 2, 1) = brightest;
    for (std::size_t i = 0; i < scene.depth.values.size(); ++i) {
        const bool sky = nearest == 0 || i % 3 == 0;
        const double metres = nearest * (1 + static_cast<double>(i % 7));
        scene.depth.values[i] = static_cast<float>(sky ? camera.sky_depth : camera.depth_at(metres));
    }
    return scene;
}

/// One executor that draws frame after frame.
class Film {
public:
    void set(const Chain& chain, int width, int height, bool fold = false) {
        PlanOptions options = linear_output();
        options.fold = fold;
        plan_ = Planner().plan(chain, facts_of(Image(width, height, 3)), options);
        executor_.prepare(plan_);
    }
    Image frame(const Scene& scene) {
        gl::Texture color(scene.color.width, scene.color.height, Format::rgba32f);
        gl::Texture depth(scene.depth.width, scene.depth.height, Format::r32f);
        color.upload(four_channels(scene.color));
        depth.upload(scene.depth);
        FrameInputs inputs;
        for (const std::string& name : plan_.attachments)
            inputs.textures.push_back(name == "depth" ? depth.name() : color.name());
        executor_.run(inputs);
        return executor_.read_picture();
    }
    Report report() const { return executor_.report(); }

private:
    Plan plan_;
    Executor executor_;
};

Image all_run(Chain chain, const Scene& scene) {
    chain.skip = Skip::nothing;
    Film film;
    film.set(chain, scene.color.width, scene.color.height);
    return film.frame(scene);
}

const PlannedEffect& effect_of(const Report& report, const std::string& name) {
    return *std::find_if(report.effects.begin(), report.effects.end(),
                         [&](const PlannedEffect& effect) { return effect.name == name; });
}

std::vector<std::string> drawn(const Report& report) {
    std::vector<std::string> names;
    for (const PassReport& pass : report.passes) {
        if (pass.drawn.value_or(true)) names.push_back(pass.name);
    }
    return names;
}

double largest_difference(const Image& a, const Image& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(static_cast<double>(a.values[i]) - b.values[i]));
    return largest;
}

using Names = std::vector<std::string>;

} // namespace

TEST_CASE("an effect that the frame does not call for is skipped, with the numbers") {
    const Quiet quiet;
    const Scene dark = scene_of(0.5f, 5), bright = scene_of(4, 5);
    Film film;
    film.set(chain_of({"flare", "curve"}), 67, 41);

    film.frame(dark);
    Report report = film.report();
    CHECK(effect_of(report, "flare").status == EffectStatus::skipped);
    CHECK(effect_of(report, "flare").moment == postfx::Moment::frame);
    CHECK(effect_of(report, "flare").kind == postfx::SkipKind::exact);
    CHECK(effect_of(report, "flare").reason == "brightest light 0.5 <= threshold 1");
    CHECK(drawn(report) == Names{"census of the picture", "flare/decision", "curve"});

    film.frame(bright);
    report = film.report();
    CHECK(effect_of(report, "flare").status == EffectStatus::fused);
    CHECK(effect_of(report, "flare").reason.ends_with("; frame: brightest light 4 is above threshold 1"));
    CHECK(drawn(report) == Names{"census of the picture", "flare/decision", "flare/bright", "flare+curve"});
}

TEST_CASE("a threshold that is just reached skips, the next float above it does not") {
    const Quiet quiet;
    Film film;
    film.set(chain_of({"flare"}), 67, 41);
    for (const auto& [brightest, skipped] :
         {std::pair{1.0f, true}, {std::nextafter(1.0f, 2.0f), false}, {std::nextafter(1.0f, 0.0f), true}}) {
        const Scene scene = scene_of(brightest, 5);
        CHECK(same_bits(film.frame(scene), all_run(chain_of({"flare"}), scene)));
        CHECK((effect_of(film.report(), "flare").status == EffectStatus::skipped) == skipped);
    }
}

TEST_CASE("when the only effect is skipped, the picture is the input bit for bit") {
    const Quiet quiet;
    Film film;
    film.set(chain_of({"flare"}), 67, 41);
    const Scene bright = scene_of(4, 5), dark = scene_of(0.5f, 5);
    film.frame(bright);
    CHECK(same_bits(film.frame(dark), four_channels(dark.color)));
    CHECK(drawn(film.report()) == Names{"census of the picture", "flare/decision", "copy"});
}

TEST_CASE("what is no number is looked at by the effect itself") {
    const Quiet quiet;
    Film film;
    film.set(chain_of({"flare", "near"}), 67, 41);
    Scene scene = scene_of(0.5f, 5);
    film.frame(scene);
    CHECK(effect_of(film.report(), "flare").status == EffectStatus::skipped);
    CHECK(effect_of(film.report(), "near").status == EffectStatus::skipped);
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN()}) {
        Scene spoiled = scene;
        spoiled.color.at(66, 40, 0) = bad;
        spoiled.depth.at(66, 40, 0) = bad;
        film.frame(spoiled);
        CHECK(effect_of(film.report(), "flare").status != EffectStatus::skipped);
        CHECK(effect_of(film.report(), "near").status != EffectStatus::skipped);
    }
    scene.color.at(0, 0, 2) = std::numeric_limits<float>::infinity();
    film.frame(scene);
    CHECK(effect_of(film.report(), "flare").status != EffectStatus::skipped);
    CHECK(effect_of(film.report(), "near").status == EffectStatus::skipped);
}

TEST_CASE("the census of a depth sees surfaces, not the sky") {
    const Quiet quiet;
    Film film;
    film.set(chain_of({"near"}), 67, 41);
    film.frame(scene_of(1, 0));
    CHECK(effect_of(film.report(), "near").reason == "distance 2 <= nearest surface inf");
    film.frame(scene_of(1, 2.5));
    CHECK(effect_of(film.report(), "near").reason == "distance 2 <= nearest surface 2.5");
    film.frame(scene_of(1, 1.5));
    CHECK(effect_of(film.report(), "near").reason.ends_with("distance 2 is above nearest surface 1.5"));
    // One near pixel in the last row and column, which only the last group of threads sees.
    Scene corner = scene_of(1, 50, 129, 130);
    corner.depth.at(128, 129, 0) = static_cast<float>(Camera().depth_at(1));
    film.set(chain_of({"near"}), 129, 130);
    film.frame(corner);
    CHECK(effect_of(film.report(), "near").status != EffectStatus::skipped);
}

TEST_CASE("every outcome of every chain shows what all effects would show, also right after another frame") {
    const Quiet quiet;
    // Float targets, so that a store that is left out leaves nothing out.
    const std::vector<std::vector<std::string>> chains = {
        {"flare"},
        {"flare", "flare"},
        {"tint", "flare", "near", "curve"},
        {"near", "flare", "blur", "near", "flare", "shift", "curve"},
        {"near", "shift", "flare", "blur"},
        {"flare", "near", "near", "near", "near", "tint"}, // more than one pass can decide on
        {"gauge", "near", "split", "flare"},
    };
    const Scene scenes[] = {scene_of(0.5f, 5), scene_of(4, 1), scene_of(0.5f, 1), scene_of(4, 5),
                            scene_of(0.25f, 0)};
    for (const std::vector<std::string>& names : chains) {
        CAPTURE(names);
        Chain chain = chain_of(names);
        for (bool fold : {false, true}) {
            Film film;
            film.set(chain, 67, 41, fold);
            std::mt19937 random(7);
            for (int frame = 0; frame < 12; ++frame) {
                const std::size_t which = random() % std::size(scenes);
                CAPTURE(frame, which, fold);
                const Image expected = all_run(chain, scenes[which]);
                // A compiler rounds constants otherwise: some float steps of at most 64.
                const double tolerance = fold ? 64 * 1e-6 : 0;
                CHECK(largest_difference(film.frame(scenes[which]), expected) <= tolerance);
            }
        }
    }
}

TEST_CASE("the first frame and the first after a resize are whole") {
    const Quiet quiet;
    const Chain chain = chain_of({"flare", "blur"});
    Film film;
    for (int size : {40, 41, 17, 64, 40}) {
        film.set(chain, size, size);
        const Scene scene = scene_of(size % 2 ? 4 : 0.5f, 5, size, size);
        CHECK(same_bits(film.frame(scene), all_run(chain, scene)));
    }
}

TEST_CASE("what is asked twice is counted once") {
    const Chain chain = chain_of({"near", "near", "flare", "flare"});
    const Plan plan = Planner().plan(chain, facts_of(Image(8, 8, 3)), linear_output());
    int of_depth = 0, of_pictures = 0;
    for (const postfx::Pass& pass : plan.passes) {
        of_depth += pass.kind == postfx::PassKind::census && pass.name == "census of depth";
        of_pictures += pass.kind == postfx::PassKind::census && pass.name == "census of the picture";
    }
    CHECK(of_depth == 1);
    // Behind the two of near it may be in two images, behind the first flare in three: counted where it is.
    CHECK(of_pictures == 2 + 3);
    CHECK(plan.censuses == 3);
}

TEST_CASE("nothing is counted for chains that skip nothing") {
    Chain chain = chain_of({"near", "flare"});
    chain.skip = Skip::nothing;
    const Plan plan = Planner().plan(chain, facts_of(Image(8, 8, 3)), linear_output());
    CHECK(plan.decisions.empty());
    for (const postfx::Pass& pass : plan.passes)
        CHECK(pass.kind == postfx::PassKind::draw);
}

TEST_CASE("a pass in tiles is drawn where its mask says, and 0 elsewhere") {
    const Quiet quiet;
    for (const auto& [width, height] : {std::pair{67, 41}, {16, 16}, {1, 1}, {160, 90}, {5, 200}}) {
        CAPTURE(width, height);
        Film film;
        film.set(chain_of({"spots", "tint"}), width, height);
        // Bright, dark, and bright again, so that what a frame leaves would show in the next.
        for (const float brightest : {4.0f, 0.5f, 2.0f}) {
            Scene scene = scene_of(0.5f, 5, width, height);
            scene.color.at(width - 1, height - 1, 2) = brightest;
            CHECK(same_bits(film.frame(scene), all_run(chain_of({"spots", "tint"}), scene)));
            const Report report = film.report();
            const auto squares =
                std::find_if(report.passes.begin(), report.passes.end(),
                             [](const PassReport& pass) { return pass.name == "spots/squares"; });
            CHECK(squares->tiles == (width + 15) / 16 * ((height + 15) / 16));
            if (brightest > 1) {
                CHECK(squares->tiles_drawn >= 1);
            } else {
                CHECK(squares->tiles_drawn == 0);
            }
        }
    }
}

TEST_CASE("a pass in tiles of an effect that the frame decides on") {
    const Quiet quiet;
    Film film;
    const Chain chain = chain_of({"flare", "spots", "flare"});
    film.set(chain, 67, 41);
    for (const float brightest : {4.0f, 0.5f, 2.0f, 0.75f}) {
        const Scene scene = scene_of(brightest, 5);
        CHECK(same_bits(film.frame(scene), all_run(chain, scene)));
    }
}
