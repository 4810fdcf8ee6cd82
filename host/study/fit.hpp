// Laws through measured points.
#pragma once

#include <postfx/curves.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace postfx::host::study {

using Points = std::vector<std::pair<double, double>>; ///< x, y

/// The b of y = a x^b, by least squares on logarithms over the points where both are positive. Nothing unless two of
/// them differ in x.
std::optional<double> exponent_of(const Points& points);

/// Through (megapixels, ms) by least squares in proportion to the time, so that the small picture counts as much as
/// the large one: fixed and per megapixel, neither below 0, or a power of the megapixels where the line would have to
/// begin below 0. Of points of one size the mean counts, so that a scene which is many times
/// slower has its say. All 0 without points.
TimeCurve fit_time(const Points& measured);

} // namespace postfx::host::study
