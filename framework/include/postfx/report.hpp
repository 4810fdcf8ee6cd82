// What a run did, why, and what it cost.
#pragma once

#include <postfx/plan.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

struct PassReport {
    std::string name;
    std::vector<std::string> effects;
    int width = 0, height = 0;
    std::string format; ///< of its first output; "census" or "decision" for passes that draw nothing
    std::vector<std::string> reads; ///< names of what it samples: attachments, or the pass that wrote it
    std::optional<double> cpu_ms;   ///< CPU time of all threads, profile mode
    std::optional<double> wall_ms;  ///< profile mode
    std::optional<double> gpu_ms;   ///< GL timestamps
    std::string condition;          ///< on which of the frame's decisions it depends; "" = none
    std::optional<bool> drawn;      ///< how they fell; absent: not known
    int tiles = 0;                  ///< that it may be drawn in; 0: it is not drawn in tiles
    std::optional<int> tiles_drawn; ///< of them; absent: not known
    /// Calls that read a texture (textureGather() is one), of all pixels or threads in the last frame, and what
    /// listing its tiles read; absent: its program does not count (PlanOptions::count_taps).
    std::optional<std::uint64_t> taps;
};

/// An image with pixels that are no numbers (NaN or infinite).
struct NonfiniteImage {
    std::string name; ///< attachment, or the pass that wrote it
    std::size_t pixels = 0;
    int x = 0, y = 0;       ///< the first, from the bottom left
    bool made_here = false; ///< nothing that the pass read had any
};

/// Of one plan.
struct ProgramCount {
    int all = 0;
    int compiled = 0; ///< of them: when the plan was prepared, neither the executor nor its cache held them
    int warmed = 0;   ///< compiled to the end on a second thread
};

struct Report {
    std::vector<PlannedEffect> effects;
    std::vector<PassReport> passes;
    std::string clock; ///< which clock the times come from, and why that one
    std::size_t texture_bytes = 0;
    std::vector<std::string> warnings;
    std::optional<ProgramCount> programs;                 ///< absent: nothing was prepared
    std::optional<std::vector<NonfiniteImage>> nonfinite; ///< in order of drawing; absent: was not watched
};

/// The plan's part of a report: everything but what a run tells.
Report describe(const Plan& plan);

/// {"effects": [{"id", "name", "status", "moment", "kind", "reason"}], "passes": [{"name", "effects", "width",
/// "height", "format", "reads", "condition", "drawn", "tiles", "tiles_drawn", "taps", "cpu_ms", "wall_ms",
/// "gpu_ms"}], "clock", "texture_bytes", "programs": {"all", "compiled", "warmed"}, "warnings", "nonfinite": [{"name",
/// "pixels", "x", "y", "made_here"}]}; what was not prepared, measured or watched is null.
std::string report_json(const Report& report);
/// The same for people.
std::string report_text(const Report& report);

/// A plan that was not drawn: report_json() of describe(), with "attachments": the names of those that the host has to
/// render. `clock`: what is said of times.
std::string plan_json(const Plan& plan, const std::string& clock = "none: nothing was drawn");
/// The same for people.
std::string plan_text(const Plan& plan, const std::string& clock = "none: nothing was drawn");

} // namespace postfx
