// The folder that a study leaves.
#pragma once

#include "findings.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host::study {

/// Write everything that is known so far: study.csv, metrics.csv, growth.csv, study.json, curves.json, <effect>*.svg,
/// pictures/<effect>-<name>.png and index.html, each either the old or the whole new one. Returns their names. Throws
/// Error.
std::vector<std::string> write_study(const std::filesystem::path& folder, const Findings& findings);

} // namespace postfx::host::study
