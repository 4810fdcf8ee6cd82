#include "chain_truth.hpp"

#include "truth_store.hpp"

#include "terminal/interruption.hpp"
#include "truths/drawn_scene.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

namespace postfx::host {
namespace {

/// Null when there is none.
const RegisteredTruth* truth_of_pixels(const std::string& effect, bool is_given) {
    const RegisteredTruth* found = nullptr;
    for (const RegisteredTruth& truth : registered_truths()) {
        if (truth.effect != effect || truth.compared != RegisteredTruth::Compared::pixels) continue;
        if (is_given && !truth.takes_given) continue;
        if (found == nullptr || truth.kind == "scene") found = &truth;
    }
    return found;
}

} // namespace

ChainTruth chain_truth(const Chain& chain, TruthRequest request, const std::filesystem::path& store) {
    ChainTruth result;
    double squares = 0;
    for (const ChainEntry& entry : chain.entries) {
        if (!entry.enabled) continue;
        request.entry = entry;
        const RegisteredTruth* truth = truth_of_pixels(entry.effect->id, request.given != nullptr);
        if (truth == nullptr)
            throw Error(Place{.effect = entry.effect->id}, "there is no truth of its pixels");
        TruthRun run(*truth, request, truth->samples);
        const std::filesystem::path file = store / run.file_name();
        run.resume(file);
        sum_up(run, file, fmt::format("truth of {}", entry.name));
        StopOnInterrupt::check();
        TruthResult found = run.result();
        squares += found.own_error * found.own_error;
        result.truths.push_back(fmt::format("{} ({})", entry.name, truth->kind));
        request.given = std::make_shared<const Image64>(std::move(found.picture));
    }
    result.own_error = std::sqrt(squares);
    result.picture = given_light(request);
    return result;
}

} // namespace postfx::host
