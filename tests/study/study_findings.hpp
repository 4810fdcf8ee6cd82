// Findings made up for tests: an effect with a ladder of levels, on two scenes.
#pragma once

#include <study/findings.hpp>

#include <string>

namespace postfx::testing {

/// A level that takes `ms` on every scene and is `error` from the truth there. It reads 4 times per pixel on the first,
/// 6.5 times on the second.
inline host::study::Level made_level(const std::string& id, double ms, double error, int scenes = 2) {
    using namespace host::study;
    Level level;
    level.id = id;
    level.passes = 1;
    level.bytes_written = 8;
    for (int i = 0; i < scenes; ++i) {
        LevelOnScene on_scene;
        on_scene.errors["scene"] = {error, error / 2};
        for (const auto& [width, height, scale] : {std::tuple(1000, 1000, 1.0), std::tuple(500, 500, 0.25)}) {
            const double here = ms * scale;
            on_scene.costs.push_back({.width = width,
                                      .height = height,
                                      .ms = {here, 0.99 * here, 1.01 * here, 11},
                                      .copies = {here / 2, 0.99 * here / 2, 1.01 * here / 2, 11}});
        }
        on_scene.taps = 4 + 2.5 * i;
        level.scenes.push_back(on_scene);
    }
    return level;
}

inline host::study::EffectFindings made_effect(std::vector<host::study::Level> levels,
                                               double own_error = 0.001) {
    using namespace host::study;
    EffectFindings effect;
    effect.id = "haze";
    effect.help = "Makes <things> hazy";
    effect.stage = "scene";
    effect.judged_by = "scene";
    effect.error_is = "relative RMSE from the truth of the scene";
    for (const char* name : {"attic", "cellar"}) {
        SceneFindings& scene = effect.scenes.emplace_back();
        scene.name = name;
        scene.description = "a room, dusty";
        scene.truths.push_back(
            {.kind = "scene", .description = "512 rays", .samples = 512, .own_error = own_error});
    }
    effect.levels = std::move(levels);
    return effect;
}

inline host::study::Findings made_findings(host::study::EffectFindings effect) {
    host::study::Findings findings;
    findings.conditions = {.program = "postfx 1.2 (commit abc)",
                           .command = "postfx study haze",
                           .device = "paper",
                           .driver = "pencil",
                           .clock = "hourglass",
                           .time_sizes = {"1000x1000", "500x500"},
                           .pixels_per_degree = 67,
                           .working_format = "rgba16f"};
    findings.base = {0.5, 2};
    findings.effects.push_back(std::move(effect));
    return findings;
}

} // namespace postfx::testing
