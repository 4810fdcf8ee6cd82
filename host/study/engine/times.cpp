#include "times.hpp"

#include "measure/measure.hpp"
#include "terminal/interruption.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace postfx::host::study {
namespace {

Chain chain_of(const std::vector<ChainEntry>& entries) {
    Chain chain;
    chain.entries = entries;
    return chain;
}

/// Draws of one size on one view.
class Stopwatch {
public:
    Stopwatch(const View& view, const std::vector<ChainEntry>& entries, const TimeOptions& options)
        : view_(view), options_(options),
          copy_(PlainPass::copy(view.size().width, view.size().height, PlanOptions().working_format)) {
        runners_.push_back(std::make_unique<ChainRunner>(chain_of({}), view.facts()));
        for (const ChainEntry& entry : entries)
            runners_.push_back(std::make_unique<ChainRunner>(chain_of({entry}), view.facts()));
        costs_.resize(entries.size());
        for (std::size_t i = 0; i < runners_.size(); ++i)
            seconds_.push_back(seconds_of(i));
    }

    TimedEntries run(const std::string& what) {
        std::vector<std::size_t> quick(costs_.size()), slow;
        std::iota(quick.begin(), quick.end(), std::size_t{1});
        std::sort(quick.begin(), quick.end(), [&](auto a, auto b) { return seconds_[a] < seconds_[b]; });
        while (quick.size() > 1 && rounds_for(quick) < options_.rounds) {
            slow.push_back(quick.back());
            quick.pop_back();
        }
        int total = all_rounds(quick);
        for (const std::size_t i : slow)
            total += all_rounds({i});
        ProgressBar progress(what, total);
        measure_together(quick, progress);
        for (const std::size_t i : slow)
            measure_together({i}, progress);
        return {costs_, spread_of(base_ms_)};
    }

private:
    void draw(std::size_t runner) { runners_[runner]->run(view_.textures(), view_.frame(), Timing::off); }

    /// Of a draw once everything is there; of the first when that takes so long that making programs and textures
    /// is nothing.
    double seconds_of(std::size_t runner) {
        constexpr double long_seconds = 3;
        const double first = seconds_of_draw(runner);
        return first > long_seconds ? first : seconds_of_draw(runner);
    }

    double seconds_of_draw(std::size_t runner) {
        StopOnInterrupt::check();
        const gl::HostTime start = gl::HostTime::now();
        draw(runner);
        glFinish();
        return (gl::HostTime::now().wall_ms - start.wall_ms) / 1000;
    }

    int rounds_for(const std::vector<std::size_t>& runners) const {
        double seconds = 2 * seconds_[0]; // the copy pass costs no more than encoding
        for (const std::size_t i : runners)
            seconds += seconds_[i];
        return std::clamp(static_cast<int>(options_.seconds / seconds) - warm_up, 1, options_.rounds);
    }
    int warm_up_for(const std::vector<std::size_t>& runners) const {
        return rounds_for(runners) > 1 ? warm_up : 0;
    }
    int all_rounds(const std::vector<std::size_t>& runners) const {
        return rounds_for(runners) + warm_up_for(runners);
    }

    void measure_together(const std::vector<std::size_t>& runners, ProgressBar& progress) {
        std::vector<Case> cases;
        cases.push_back({"copy", [this] { copy_.draw(view_.textures().at("color")); }});
        cases.push_back({"base", [this] { draw(0); }});
        for (const std::size_t i : runners)
            cases.push_back({"", [this, i] { draw(i); }});
        measure(
            cases, rounds_for(runners), progress, [] { StopOnInterrupt::check(); }, warm_up_for(runners));
        const double copy = median(cases[0].times(options_.gpu));
        const std::vector<double>& base = cases[1].times(options_.gpu);
        base_ms_.insert(base_ms_.end(), base.begin(), base.end());
        for (std::size_t k = 0; k < runners.size(); ++k) {
            std::vector<double> added = differences(base, cases[k + 2].times(options_.gpu));
            Cost& cost = costs_[runners[k] - 1];
            cost.width = view_.size().width;
            cost.height = view_.size().height;
            cost.ms = spread_of(added);
            for (double& value : added)
                value /= copy;
            cost.copies = spread_of(added);
        }
    }

    /// Each was drawn before, and what is drawn but once is slow enough.
    static constexpr int warm_up = 1;

    const View& view_;
    TimeOptions options_;
    PlainPass copy_;
    std::vector<std::unique_ptr<ChainRunner>> runners_; ///< without effects, then those of the entries
    std::vector<double> seconds_, base_ms_;
    std::vector<Cost> costs_;
};

double written_by(const Plan& plan) {
    double bytes = 0;
    for (const Pass& pass : plan.passes) {
        for (const ImageRef& output : pass.outputs)
            bytes += static_cast<double>(plan.targets[static_cast<std::size_t>(output.index)].bytes());
    }
    return bytes;
}

double read_by(const Plan& plan, const View& view) {
    double bytes = 0;
    for (const Pass& pass : plan.passes) {
        std::vector<ImageRef> seen;
        for (const PassInput& input : pass.inputs) {
            if (std::find(seen.begin(), seen.end(), input.image) != seen.end()) continue;
            seen.push_back(input.image);
            const auto index = static_cast<std::size_t>(input.image.index);
            if (input.image.kind == ImageRef::Kind::target)
                bytes += static_cast<double>(plan.targets[index].bytes());
            else if (input.image.kind == ImageRef::Kind::attachment)
                bytes += view.bytes_of(plan.attachments[index]);
        }
    }
    return bytes;
}

/// Of a whole chain, all pixels of all its passes.
double all_taps(const View& view, const Chain& chain) {
    ChainRunner runner(chain, view.facts(), {.count_taps = true});
    runner.run(view.textures(), view.frame(), Timing::off);
    double taps = 0;
    for (const PassReport& pass : runner.executor().report().passes)
        taps += static_cast<double>(pass.taps.value());
    return taps;
}

} // namespace

TimedEntries measure_entries(const View& view, const std::vector<ChainEntry>& entries,
                             const TimeOptions& options, const std::string& what) {
    return Stopwatch(view, entries, options).run(what);
}

Work work_of(const View& view, const ChainEntry& entry) {
    Planner planner;
    const SceneFacts& facts = view.facts();
    const Plan with = planner.plan(chain_of({entry}), facts), without = planner.plan(chain_of({}), facts);
    const double pixels = static_cast<double>(facts.width) * facts.height;
    return {static_cast<int>(with.passes.size()) - static_cast<int>(without.passes.size()),
            (written_by(with) - written_by(without)) / pixels,
            (read_by(with, view) - read_by(without, view)) / pixels};
}

double taps_of(const View& view, const ChainEntry& entry) {
    const double pixels = static_cast<double>(view.size().width) * view.size().height;
    return (all_taps(view, chain_of({entry})) - all_taps(view, chain_of({}))) / pixels;
}

} // namespace postfx::host::study
