#include <report/run.hpp>

#include <plan/condition.hpp>

#include <fmt/format.h>

#include <utility>

namespace postfx {

void tell_decisions(const FrameOutcome& outcome, const Plan& plan, Report& report) {
    for (PlannedEffect& effect : report.effects) {
        if (effect.decision < 0) continue;
        const Decision& decision = plan.decisions[effect.decision];
        const auto [compared, limit] = outcome.compared[effect.decision];
        const bool live = (outcome.live >> effect.decision & 1u) != 0;
        const std::string numbers = fmt::format("{} {:.4g} {} {} {:.4g}", decision.compared, compared,
                                                live ? "is above" : "<=", decision.limit, limit);
        if (live) {
            effect.reason =
                fmt::format("{}; frame: {}", plan.effects[&effect - report.effects.data()].reason, numbers);
        } else {
            effect.status = EffectStatus::skipped;
            effect.moment = Moment::frame;
            effect.kind = decision.kind;
            effect.reason = numbers;
        }
    }
    for (std::size_t i = 0; i < report.passes.size(); ++i)
        report.passes[i].drawn = holds(plan.passes[i].condition, outcome.live);
}

void tell_tiles(const std::vector<std::optional<int>>& drawn, Report& report) {
    for (std::size_t i = 0; i < drawn.size(); ++i)
        report.passes[i].tiles_drawn = drawn[i];
}

void tell_taps(const std::vector<std::uint64_t>& taps, Report& report) {
    for (std::size_t i = 0; i < taps.size(); ++i) {
        PassReport& pass = report.passes[i];
        pass.taps = taps[i] + (pass.drawn.value_or(true) ? static_cast<std::uint64_t>(pass.tiles) : 0);
    }
}

std::vector<NonfiniteImage> nonfinite_images(const Plan& plan, const std::vector<NonfiniteCount>& counts) {
    std::vector<NonfiniteImage> found;
    const auto keep = [&](const NonfiniteCount& count, std::string name, int width, bool made_here) {
        if (count.pixels == 0) return;
        const int first = static_cast<int>(count.first);
        found.push_back({std::move(name), count.pixels, first % width, first / width, made_here});
    };
    std::size_t slot = 0;
    std::vector<bool> attachment_has, target_has(plan.targets.size());
    for (const std::string& name : plan.attachments) {
        attachment_has.push_back(counts[slot].pixels > 0);
        keep(counts[slot++], name, plan.width, false);
    }
    // Passes may take turns with one target, so that what it held last is followed along them.
    for (const Pass& pass : plan.passes) {
        bool came_in = false;
        for (const PassInput& input : pass.inputs) {
            const bool is_attachment = input.image.kind == ImageRef::Kind::attachment;
            came_in = came_in || (is_attachment ? attachment_has : target_has)[input.image.index];
        }
        for (std::size_t i = 0; i < pass.outputs.size(); ++i, ++slot) {
            target_has[pass.outputs[i].index] = counts[slot].pixels > 0;
            keep(counts[slot],
                 pass.outputs.size() == 1 ? pass.name : fmt::format("{} output {}", pass.name, i), pass.width,
                 !came_in);
        }
    }
    return found;
}

void tell_profile(const std::vector<PassTime>& times, const std::string& clock, Report& report) {
    for (std::size_t i = 0; i < report.passes.size(); ++i) {
        report.passes[i].cpu_ms = times[i].cpu_ms;
        report.passes[i].wall_ms = times[i].wall_ms;
    }
    report.clock =
        "CPU time of all threads and wall time around each finished pass (profile mode; " + clock + ")";
}

void tell_gpu_times(const std::vector<double>& times, const std::string& clock, Report& report) {
    for (std::size_t i = 0; i < times.size(); ++i)
        report.passes[i].gpu_ms = times[i];
    report.clock = clock;
}

} // namespace postfx
