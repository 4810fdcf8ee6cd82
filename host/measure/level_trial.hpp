// What levels do in one picture: drawn instead of taken from curves, which are means over other scenes. [GL thread]
#pragma once

#include "run/chain_runner.hpp"
#include "run/scene_view.hpp"

#include <postfx/budget.hpp>

#include <functional>
#include <string>
#include <vector>

namespace postfx::host {

/// What a chain is tried on.
struct TrialInputs {
    /// Draw the scene with these attachments; they have to stay until the next call.
    std::function<Textures(const std::vector<std::string>& attachments)> draw_scene;
    FrameInputs frame;
};

/// The chain up to its tone map, with one effect at a time at each level that the budget may have a use for, and the
/// others at their least exact ones. What stands behind (noise, for one) can't be judged by its pixels and is not tried.
/// Throws Error.
LevelTrial try_levels(const Chain& chain, const BudgetQuestion& question, const Budget& budget,
                      const SceneFacts& facts, PlanOptions options, const TrialInputs& inputs);

/// What levels are tried on: the facts' picture, drawn by `renderer`, which has to stay.
TrialInputs trial_inputs(SceneRenderer& renderer, const SceneFacts& facts, double time);

} // namespace postfx::host
