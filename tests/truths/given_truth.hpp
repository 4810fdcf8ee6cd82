// A truth of a picture that the test makes: no scene, no OpenGL.
#pragma once

#include <catch2/catch.hpp>

#include <testing.hpp>
#include <truths/truth_run.hpp>

#include <map>
#include <memory>
#include <string>

namespace postfx::testing {

/// `light` has 3 channels; values by parameter, others as the effect has them.
inline host::TruthResult truth_of(const std::string& effect, const std::string& kind, const Image64& light,
                                  const std::map<std::string, double>& values, int samples,
                                  std::uint32_t frame = 0) {
    Chain chain;
    ChainEntry entry = chain.add(catalog(), effect);
    for (const auto& [name, value] : values)
        REQUIRE(entry.set(name, value));
    const host::TruthRequest request{.scene = {},
                                     .width = light.width,
                                     .height = light.height,
                                     .entry = entry,
                                     .frame = frame,
                                     .given = std::make_shared<const Image64>(light)};
    host::TruthRun run(host::find_truth(effect, kind), request, samples);
    while (!run.complete())
        run.step();
    return run.result();
}

} // namespace postfx::testing
