// What the numbers say, in plain English.
#pragma once

#include "findings.hpp"

#include <string>
#include <vector>

namespace postfx::host::study {

/// "1.6x", "12x", "350x": with as many digits as mean something.
std::string times_text(double ratio);
/// "0.35 %", "12 %", "0".
std::string percent_text(double share);
/// "0.35 ms", "1.2 s".
std::string duration_text(double ms);

/// The first is for those who read no further: how each level compares with the one before it. The others tell about
/// classic, dominated levels, what limits, and what grows.
std::vector<std::string> sentences_of(const EffectFindings& effect);

} // namespace postfx::host::study
