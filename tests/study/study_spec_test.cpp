// What a study file and an effect's own entry say, what is refused of them, and that the shipped ones fit this build.
#include <catch2/catch.hpp>

#include <study/spec.hpp>
#include <temporary_directory.hpp>
#include <testing.hpp>

#include <postfx/error.hpp>

#include <scene/scene.hpp>

#include <fstream>
#include <map>

using namespace postfx::host::study;
using postfx::testing::catalog;

namespace {

std::string refusal(const std::string& yaml) {
    try {
        Spec::parse(yaml, "study.yaml");
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "";
}

postfx::EffectInfo effect_named(const std::string& id) {
    postfx::EffectInfo effect;
    effect.id = id;
    return effect;
}

postfx::EffectInfo effect_with_range(double low, double high) {
    postfx::EffectInfo effect = effect_named("haze");
    postfx::ParameterInfo parameter;
    parameter.id = "reach";
    parameter.minimum = low;
    parameter.maximum = high;
    effect.parameters.push_back(parameter);
    return effect;
}

} // namespace

TEST_CASE("an effect has what its entry says, and the rest of the default") {
    const Spec spec = Spec::parse(R"(
default: {scenes: [attic, cellar]}
effects:
  haze:
    values: {amount: 0.5, mode: soft, color: [1, 0.5, 0]}
    judged_by: layer
    size: 1280x720
    radius: {parameter: reach, per_height: 2, at_most: 0.1, scene: attic, values: {mode: hard}}
  mist: {scenes: [cellar]}
)",
                                  "study.yaml");
    const EffectSpec haze = spec.of(effect_named("haze"));
    CHECK(haze.scenes == std::vector<std::string>{"attic", "cellar"});
    CHECK(haze.values == "amount: 0.5, mode: soft, color: [1, 0.5, 0]");
    CHECK(haze.judged_by == "layer");
    REQUIRE(haze.radius);
    CHECK(haze.radius->per_height == 2);
    CHECK(haze.radius->values == "mode: hard");
    CHECK(haze.size == "1280x720");
    CHECK(spec.of(effect_named("mist")).size.empty());
    CHECK(spec.of(effect_named("mist")).scenes == std::vector<std::string>{"cellar"});
    CHECK(spec.of(effect_named("unheard_of")).scenes.size() == 2);
    CHECK_FALSE(spec.of(effect_named("unheard_of")).radius);
}

TEST_CASE("an effect's own entry lies beside its module, and a study file goes before it") {
    const postfx::testing::TemporaryDirectory folder;
    postfx::EffectInfo effect = effect_named("haze");
    effect.module_path = folder / "postfx_any.so";
    const Spec general = Spec::parse("default: {scenes: [attic], judged_by: scene}", "study.yaml");
    CHECK(general.of(effect).scenes == std::vector<std::string>{"attic"});

    std::ofstream(folder / "postfx_haze.study.yaml") << "scenes: [cellar]\nvalues: {amount: 0.5}\n";
    const EffectSpec own = general.of(effect);
    CHECK(own.scenes == std::vector<std::string>{"cellar"});
    CHECK(own.values == "amount: 0.5");
    CHECK(own.judged_by == "scene"); // what it does not say has the default
    const Spec special = Spec::parse("default: {scenes: [attic]}\neffects: {haze: {}}", "study.yaml");
    CHECK(special.of(effect).values.empty());

    std::ofstream(folder / "postfx_haze.study.yaml") << "scenes: [cellar]\nvalue: {amount: 0.5}\n";
    CHECK_THROWS_WITH(general.of(effect),
                      Catch::Contains("postfx_haze.study.yaml:2:") && Catch::Contains("values"));
}

TEST_CASE("what a study file says wrongly is refused at its place") {
    CHECK_THAT(refusal("effects: {}"), Catch::Contains("default"));
    CHECK_THAT(refusal("default: {scenes: []}"), Catch::Contains("at least one scene"));
    CHECK_THAT(refusal("default: {scenes: [a]}\neffects:\n  haze: {scene: [b]}"),
               Catch::StartsWith("study.yaml:3:") && Catch::Contains("scenes"));
    CHECK_THAT(refusal("default: {scenes: [a]}\neffects:\n  haze: {judged_by: eye}"),
               Catch::Contains("layer"));
    CHECK_THAT(refusal("default: {scenes: [a]}\neffects:\n  haze: {radius: {per_height: 1}}"),
               Catch::Contains("parameter"));
}

TEST_CASE("a radius in pixels is a share of the height, within what the parameter can be") {
    const RadiusSpec radius{.parameter = "reach", .per_height = 2, .at_most = 0.2, .scene = "", .values = ""};
    const postfx::EffectInfo effect = effect_with_range(0.01, 0.3);
    CHECK(value_for_radius(radius, effect, 10, 200).value() == Approx(0.1));
    CHECK_FALSE(value_for_radius(radius, effect, 0.5, 200));                   // 0.005: below the range
    CHECK_FALSE(value_for_radius(radius, effect, 35, 200));                    // 0.35: above the range
    CHECK_FALSE(value_for_radius({"reach", 1, 0.2, "", ""}, effect, 50, 200)); // a quarter of the height
    CHECK_THROWS_AS(value_for_radius({"raech", 1, 1, "", ""}, effect, 1, 200), postfx::Error);
}

TEST_CASE("the shipped study fits effects and scenes") {
    const std::filesystem::path configs = POSTFX_SOURCE_DIRECTORY "/configs";
    const Spec spec = Spec::read(configs / "study.yaml");
    for (const postfx::EffectPtr& effect : catalog().effects()) {
        INFO(effect->id);
        const EffectSpec own = spec.of(*effect);
        CHECK(entry_of(catalog(), effect->id, own).effect == effect);
        for (const std::string& scene : own.scenes)
            CHECK(std::filesystem::is_regular_file(configs / "scenes" / (scene + ".yaml")));
        if (!own.radius) continue;
        CHECK(growing_entry_of(catalog(), effect->id, own).effect == effect);
        int radii = 0;
        for (double pixels = 2; pixels <= 256; pixels *= 2)
            radii += value_for_radius(*own.radius, *effect, pixels, 720).has_value() ? 1 : 0;
        CHECK(radii >= 2); // or no exponent can be fitted
    }
}
