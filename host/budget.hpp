// Chains that ask for a budget: levels are chosen before anything is planned for drawing, and, in a window, kept right.
#pragma once

#include "curves.hpp"
#include "picture.hpp"

#include <gl/clock.hpp>

#include <postfx/budget.hpp>

#include <memory>
#include <optional>
#include <string>

namespace postfx::host {

/// What a chain's budget bought.
struct MetBudget {
    Budget budget;
    FoundCurves curves;
    BudgetQuestion question;
    BudgetAnswer answer;

    /// budget_text() and where the curves are from.
    std::string text() const;
    /// budget_json() with "curves": {"file", "device", "driver", "clock", "note"}.
    std::string json() const;
};

/// Set the chain's levels to what its budget buys in a picture of these facts; nothing happens to a chain without a
/// budget. `curves`: a file, or "" for those of the current OpenGL context's device.
std::optional<MetBudget> meet_budget(Chain& chain, const Facts& facts, const std::filesystem::path& curves);

/// What a chain takes, by the clock that curves are measured with. [GL thread]
class ChainTimer {
public:
    ChainTimer();
    void begin();
    void end();
    /// Of a frame that was drawn not long ago; nothing until there is one.
    std::optional<double> ms();

private:
    std::optional<gl::TimestampRing> ring_; ///< when the GPU's clock is to be believed
    gl::HostTime start_;
    std::optional<double> host_ms_;
};

/// A budget while the chain runs. [GL thread]
class RunningBudget {
public:
    RunningBudget(MetBudget met, const ChainRunner& runner);

    /// Draw the chain, and change its levels for the next frame when that is called for.
    std::uint32_t run(ChainRunner& runner, const Textures& textures, const FrameInputs& frame);
    /// Choose anew, as at the start: somebody changed the chain.
    void choose_again(ChainRunner& runner);
    /// The present levels and what the keeper makes of its measurements, for people.
    std::string text(const ChainRunner& runner) const;

private:
    BudgetQuestion question_of(const ChainRunner& runner) const;

    MetBudget met_;
    BudgetKeeper keeper_;
    ChainTimer timer_;
};

} // namespace postfx::host
