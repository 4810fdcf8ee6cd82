// What a whole chain ought to give. [GL thread]
#pragma once

#include "truths/truth_run.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host {

struct ChainTruth {
    Image64 picture; ///< 3 channels, linear
    double own_error =
        0; ///< of all truths, each relative to its picture; they are independent, so squares add
    std::vector<std::string> truths; ///< that it is made of: "shade (layer)"
};

/// The truth of every enabled effect, given what the truths before it made: of the phenomenon itself where that can be
/// had of a given picture, else the best that the effect's inputs allow. `request` says all but the effect. Sums are
/// kept in `store` like those of single truths. Throws Error for an effect without a truth of its pixels, Interrupted
/// when asked to stop (a StopOnInterrupt must live).
ChainTruth chain_truth(const Chain& chain, TruthRequest request, const std::filesystem::path& store);

} // namespace postfx::host
