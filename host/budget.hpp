// Chains that ask for a budget: levels are chosen before anything is planned for drawing, and, in a window, kept right.
#pragma once

#include "curves.hpp"
#include "level_trial.hpp"
#include "options.hpp"
#include "picture.hpp"

#include <gl/clock.hpp>
#include <gl/cross_fade.hpp>

#include <postfx/budget.hpp>

#include <memory>
#include <optional>
#include <string>

namespace postfx::host {

/// What a chain's budget bought.
struct MetBudget {
    Budget budget;
    FoundCurves curves;
    LevelTrial trial; ///< of the levels in the scene; empty: they were not tried
    BudgetQuestion question;
    BudgetAnswer answer;

    /// budget_text(), and where times and errors are from.
    std::string text() const;
    /// budget_json() with "curves": {"file", "device", "driver", "clock", "note"} and "tried": names of effects whose
    /// levels were tried in the scene.
    std::string json() const;
};

/// Set the chain's levels to what its budget buys in a picture of these facts; nothing happens to a chain without a
/// budget.
std::optional<MetBudget> meet_budget(Chain& chain, const Facts& facts, const BudgetSource& source,
                                     const TrialInputs& inputs);

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

    /// What has to be in the next frame's textures: more than the chain reads when its levels are about to change.
    std::vector<std::string> attachments(const ChainRunner& runner) const;
    /// Draw the chain, and change its levels when that is called for: where it would be seen, over several frames, in the
    /// first of which the chain is drawn at both levels.
    std::uint32_t run(ChainRunner& runner, const Textures& textures, const FrameInputs& frame);
    /// Choose anew, as at the start: somebody changed the chain.
    void choose_again(ChainRunner& runner);
    /// The same by what levels do in the present picture.
    void try_again(ChainRunner& runner, const TrialInputs& inputs);
    /// The present levels and what the keeper makes of its measurements, for people.
    std::string text(const ChainRunner& runner) const;

private:
    BudgetQuestion question_of(const ChainRunner& runner) const;
    std::uint32_t change_levels(ChainRunner& runner, const Textures& textures, const FrameInputs& frame);

    MetBudget met_;
    BudgetKeeper keeper_;
    ChainTimer timer_;
    gl::CrossFade cross_fade_;
    std::optional<LevelChange> next_change_; ///< in the next frame
};

} // namespace postfx::host
