// What levels cost, measured in turns. [GL thread]
#pragma once

#include "study/findings.hpp"
#include "view.hpp"

#include <string>
#include <vector>

namespace postfx::host::study {

struct TimeOptions {
    int rounds = 11; ///< of what is quick enough for so many
    double seconds =
        30; ///< that what is measured together may take; slower things get fewer rounds, at least one
    bool gpu = false; ///< believe the GPU's clock
};

struct TimedEntries {
    std::vector<Cost> costs; ///< that each entry alone adds to a chain, as they were given
    Spread base_ms;          ///< of a chain without effects
};

/// Each entry alone in a chain that encodes for a display, values in uniforms as while they are moved, against the
/// same chain without an effect. Everything that is quick is drawn in turns; what is slow, each in turns with the
/// chain without effects. `what` stands before the progress. Throws Interrupted.
TimedEntries measure_entries(const View& view, const std::vector<ChainEntry>& entries,
                             const TimeOptions& options, const std::string& what);

/// What an entry adds to a chain's plan.
struct Work {
    int passes = 0;
    double bytes_written = 0, bytes_read = 0; ///< per pixel of the picture
};
Work work_of(const View& view, const ChainEntry& entry);

/// Texture reads per pixel of the picture that an entry adds to a chain when it draws the view. Throws Error if its
/// shaders can't count them.
double taps_of(const View& view, const ChainEntry& entry);

} // namespace postfx::host::study
