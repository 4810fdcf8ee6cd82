// A budget kept while its chain is drawn: levels change, and the change is faded. [thread of the context]
#pragma once

#include "met_budget.hpp"

#include "run/chain_runner.hpp"

#include <gl/clock.hpp>
#include <gl/cross_fade.hpp>

#include <postfx/budget.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

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
