// What was found, for other programs.
#pragma once

#include "findings.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace postfx::host::study {

/// One row per effect, scene and level, with a line of names first (RFC 4180, lines end in \n). What was not measured
/// or is not finite is empty.
std::string findings_csv(const Findings& findings);

/// One row per effect, level and metric.
std::string metrics_csv(const Findings& findings);

/// One row per effect, level and point of growth.
std::string growth_csv(const Findings& findings);

/// Everything but the pictures. What was not measured or is not finite is null.
nlohmann::ordered_json findings_json(const Findings& findings);

} // namespace postfx::host::study
