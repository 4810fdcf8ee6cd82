// The plots of an effect.
#pragma once

#include "findings.hpp"

#include <string>
#include <vector>

namespace postfx::host::study {

struct EffectPlot {
    std::string
        name; ///< of the file, behind the effect's id: "error", "layer", "flip", "growth_radius_time", ...
    std::string caption;
    std::string svg;
};

/// Error against time: from the truth that judges, from the other one if there is one, and as a viewer sees it.
std::vector<EffectPlot> error_plots(const EffectFindings& effect);
/// Time and error against what grows.
std::vector<EffectPlot> growth_plots(const EffectFindings& effect);

} // namespace postfx::host::study
