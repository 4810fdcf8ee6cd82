// Truths as tests ask for them: of a scene in YAML, or of a picture that the test makes (no scene, no OpenGL).
#pragma once

#include <catch2/catch.hpp>

#include <testing.hpp>
#include <truths/truth_run.hpp>

#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <string>

namespace postfx::testing {

/// By parameter; others as the effect has them.
using Numbers = std::map<std::string, double>;

inline ChainEntry entry_of(const std::string& effect, const Numbers& values = {}) {
    Chain chain;
    ChainEntry entry = chain.add(catalog(), effect);
    for (const auto& [name, value] : values)
        REQUIRE(entry.set(name, value));
    return entry;
}

/// Of a scene, `size` pixels wide and high.
inline host::TruthRequest request_of(const std::string& effect, const std::string& scene, int size,
                                     const Numbers& values = {}) {
    return {.scene = host::parse_scene(scene, "test.yaml"),
            .width = size,
            .height = size,
            .entry = entry_of(effect, values)};
}

inline host::TruthResult truth_of(const host::TruthRequest& request, const std::string& kind, int samples) {
    host::TruthRun run(host::find_truth(request.entry.effect->id, kind), request, samples);
    while (!run.complete())
        run.step();
    return run.result();
}

/// `light` has 3 channels.
inline host::TruthResult truth_of(const std::string& effect, const std::string& kind, const Image64& light,
                                  const Numbers& values, int samples, std::uint32_t frame = 0) {
    return truth_of({.scene = {},
                     .width = light.width,
                     .height = light.height,
                     .entry = entry_of(effect, values),
                     .frame = frame,
                     .given = std::make_shared<const Image64>(light)},
                    kind, samples);
}

/// Of a scene that is drawn with one sample per pixel; the effect is given that light everywhere, the scene's where it is
/// below 0.
inline host::TruthResult truth_in(const std::string& effect, const std::string& scene,
                                  const std::string& kind, int size, int samples, const Numbers& values,
                                  double light = -1) {
    host::TruthRequest request = request_of(effect, scene, size, values);
    request.scene_samples = 1;
    if (light >= 0) request.given = std::make_shared<const Image64>(size, size, 3, light);
    return truth_of(request, kind, samples);
}

/// Of two pictures of one size.
inline double root_mean_square_difference(const Image64& a, const Image64& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        sum += (a.values[i] - b.values[i]) * (a.values[i] - b.values[i]);
    return std::sqrt(sum / static_cast<double>(a.values.size()));
}

} // namespace postfx::testing
