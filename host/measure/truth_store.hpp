// Where truths are kept while they are summed up, and between commands.
#pragma once

#include "truths/truth_run.hpp"

#include <filesystem>
#include <string>

namespace postfx::host {

/// `folder`, or truths/ in the user's cache when that is empty; made when it is missing. Throws Error.
std::filesystem::path truth_store(const std::string& folder);

/// Add samples until the truth is complete or an interruption asks to stop (a StopOnInterrupt must live); `file` is
/// written now and then and at the end. `what` stands before the progress.
void sum_up(TruthRun& run, const std::filesystem::path& file, const std::string& what);

} // namespace postfx::host
