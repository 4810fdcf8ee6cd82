// How time and error grow with the radius and with the picture. [GL thread]
#pragma once

#include "pictures.hpp"
#include "study/spec.hpp"
#include "times.hpp"

#include <optional>
#include <string>
#include <vector>

namespace postfx::host::study {

struct GrowthInputs {
    StudyScene& scene;
    std::vector<ChainEntry> entries; ///< one per level
    std::vector<ChainEntry>
        growing_entries; ///< the same, with the values that they have while the radius grows
    std::optional<RadiusSpec> radius;
    std::string judged_by;
    Size picture, time_size;
    TruthOptions truths;
    TimeOptions times;
    double limit_ms; ///< levels that take longer are left out
};

/// Over the radius, if the effect has one, and over the number of pixels. `findings` tells what levels cost.
std::vector<Growth> find_growth(const GrowthInputs& inputs, const EffectFindings& findings);

} // namespace postfx::host::study
