// What a run measured, put into its plan's report. The numbers were read from the GPU before; no OpenGL.
#pragma once

#include <postfx/plan.hpp>
#include <postfx/report.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

/// How one frame's decisions fell.
struct FrameOutcome {
    std::uint32_t live = 0;                     ///< a bit for each decision that was for its effect
    std::vector<std::array<float, 2>> compared; ///< per decision: the number that was found, and its limit
};
/// What the frame decided, in the report's own words; passes that were not drawn leave it.
void tell_decisions(const FrameOutcome& outcome, const Plan& plan, Report& report);

/// `drawn`: tiles of each pass; nothing for those that are drawn everywhere.
void tell_tiles(const std::vector<std::optional<int>>& drawn, Report& report);

/// What the last frame read: its programs, pass by pass, and for tiles the mask, each tile of which is looked at once.
void tell_taps(const std::vector<std::uint64_t>& taps, Report& report);

/// Pixels of one image that are no numbers; layout as the program that counts them has it.
struct NonfiniteCount {
    std::uint32_t pixels = 0;
    std::uint32_t first = UINT32_MAX; ///< y * width + x
};
/// `counts`: of the plan's attachments first, then of every pass's outputs in order.
std::vector<NonfiniteImage> nonfinite_images(const Plan& plan, const std::vector<NonfiniteCount>& counts);

struct PassTime {
    double cpu_ms = 0, wall_ms = 0;
};
/// One time for each pass.
void tell_profile(const std::vector<PassTime>& times, const std::string& clock, Report& report);

/// GL timestamps, milliseconds, of the first passes or all; `clock` is why they are believed.
void tell_gpu_times(const std::vector<double>& times, const std::string& clock, Report& report);

} // namespace postfx
