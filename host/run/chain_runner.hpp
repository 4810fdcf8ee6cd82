// One chain, planned and drawn frame after frame. [thread of the context]
#pragma once

#include <postfx/postfx.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace postfx::host {

/// GL names of textures by attachment name.
using Textures = std::map<std::string, std::uint32_t>;

/// Runs one chain on textures, planning again when facts change.
class ChainRunner {
public:
    /// `formats`: of the attachments, by name. Given, and up to the first run, a second thread compiles too where that
    /// helps (Executor::prepare).
    ChainRunner(Chain chain, SceneFacts facts, const PlanOptions& options = {},
                const std::map<std::string, Format>& formats = {});

    /// What the chain reads of the scene, decided before anything is rendered.
    const std::vector<std::string>& attachments() const { return plan_.attachments; }
    const Plan& plan() const { return plan_; }
    Chain& chain() { return chain_; }
    const Chain& chain() const { return chain_; }

    /// Plan again for another camera or changed values, with the same options. A failing shader throws and the old plan stays.
    void replan(const SceneFacts& facts);

    /// Draw one frame. `textures` must hold what attachments() names. Returns the picture's texture.
    std::uint32_t run(const Textures& textures, const FrameInputs& frame, Timing timing,
                      Watch watch = Watch::off);

    Executor& executor() { return executor_; }
    const SceneFacts& facts() const { return facts_; }
    const PlanOptions& options() const { return options_; }

private:
    Planner planner_;
    Chain chain_;
    SceneFacts facts_;
    PlanOptions options_;
    Plan plan_;
    Executor executor_;
    FrameInputs inputs_;
};

} // namespace postfx::host
