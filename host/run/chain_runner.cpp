#include "chain_runner.hpp"

#include "resources.hpp"

#include <utility>

namespace postfx::host {
namespace {

std::filesystem::path program_cache() {
    const std::filesystem::path cache = cache_directory();
    return cache.empty() ? cache : cache / "programs";
}

} // namespace

ChainRunner::ChainRunner(Chain chain, SceneFacts facts, const PlanOptions& options,
                         const std::map<std::string, Format>& formats)
    : chain_(std::move(chain)), facts_(std::move(facts)), options_(options),
      plan_(planner_.plan(chain_, facts_, options_)), executor_(program_cache()) {
    std::vector<Format> of_attachments;
    if (!formats.empty()) {
        for (const std::string& name : plan_.attachments)
            of_attachments.push_back(formats.at(name));
    }
    executor_.prepare(plan_, of_attachments);
}

void ChainRunner::replan(const SceneFacts& facts) {
    Plan plan = planner_.plan(chain_, facts, options_);
    executor_.prepare(plan);
    plan_ = std::move(plan);
    facts_ = facts;
}

std::uint32_t ChainRunner::run(const Textures& textures, const FrameInputs& frame, Timing timing,
                               Watch watch) {
    inputs_.textures.clear();
    for (const std::string& name : plan_.attachments)
        inputs_.textures.push_back(textures.at(name));
    inputs_.camera = frame.camera;
    inputs_.time = frame.time;
    inputs_.frame = frame.frame;
    inputs_.seed = frame.seed;
    return executor_.run(inputs_, timing, watch);
}

} // namespace postfx::host
