// Which levels are worth having.
#pragma once

#include "findings.hpp"

#include <string>
#include <vector>

namespace postfx::host::study {

/// Fill in what follows from an effect's measurements: error, ms, time, dominated_by, on_hull.
///
/// A level is dominated when another is clearly better in time or in error and not worse in the other. Times differ
/// clearly when their medians are farther apart than twice the root of their squared uncertainties, and by more than
/// 2 %; errors when they are more than 2 % apart, where all that are below the truth's own error count as that.
void conclude(EffectFindings& effect);

/// Indices of levels with an error, each slower and closer to the truth than the one before: the curve that a budget
/// chooses from. Never the level classic.
std::vector<std::size_t> curve_of(const EffectFindings& effect);

/// Indices of points (x, y) on the lower left convex hull, in order of x.
std::vector<std::size_t> lower_hull(const std::vector<std::pair<double, double>>& points);

/// For a budget: effects whose levels have no error are left out.
Curves curves_of(const Findings& findings);

} // namespace postfx::host::study
