// How a finished run is told: for people on stdout, or as JSON for scripts.
#pragma once

#include "budget/met_budget.hpp"
#include "run/picture_file.hpp"

#include <postfx/executor.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace postfx::host {

/// --json, --quiet, --no-times and --watch-nonfinite of commands that run a chain.
class ReportOptions {
public:
    void declare(CLI::App& app);
    bool quiet() const { return quiet_; }
    bool wants_times() const { return !no_times_ && !quiet_; }
    Watch watch() const { return watch_nonfinite_ ? Watch::nonfinite : Watch::off; }
    /// The report, what the budget bought if there was one, and "wrote FILE"; as JSON {"output": FILE, ...report,
    /// "budget": ...}. On stderr when the picture went to stdout.
    void tell(const Report& report, const std::optional<MetBudget>& budget, const PictureFile& output) const;

private:
    bool json_ = false, quiet_ = false, no_times_ = false, watch_nonfinite_ = false;
};

} // namespace postfx::host
