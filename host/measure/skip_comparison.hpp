// What it saves to leave out what a scene does not call for. [GL thread]
#pragma once

#include "measure.hpp"

#include "run/chain_runner.hpp"
#include "terminal/progress_bar.hpp"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace postfx::host {

/// Draws chains on one view of a scene, as they are and with everything run, and compares what both cost.
class SkipComparison {
public:
    /// `facts` are of the view at `time`.
    SkipComparison(const Scene& scene, SceneFacts facts, const PlanOptions& options, double time);

    void add(std::string name, Chain chain);
    /// All that was added, in turns.
    void measure(int rounds, ProgressBar& progress);

    /// A frame: the scene with what the chain reads, then the chain.
    struct Frame {
        double ms = 0;       ///< of all, median
        double chain_ms = 0; ///< of the chain alone
        std::size_t texture_bytes = 0;
        std::vector<std::string> attachments; ///< that the chain reads
    };
    struct Row {
        std::string name;
        Report report; ///< as it is, with what the frame decided
        /// Nothing is skipped and no frame may skip anything: both are the same frame.
        bool same = false;
        Frame as_is, no_skip;
        double saved_ms = 0, saved_p10 = 0, saved_p90 = 0; ///< over the rounds, no_skip - as_is

        std::size_t skipped() const; ///< how many effects were
        std::int64_t saved_bytes() const;
    };
    struct Result {
        std::string clock;
        int rounds = 0;
        double copy_ms = 0;    ///< of a pass that copies the picture in the working format
        double scene_ms = 0;   ///< with color and depth alone
        std::vector<Row> rows; ///< in the order of add()
    };
    const Result& result() const { return result_; }

private:
    struct Side {
        std::unique_ptr<ChainRunner> runner;
        std::size_t scene_case = 0, chain_case = 0; ///< into cases_
    };
    struct Pair {
        std::string name;
        bool same = false;
        Side as_is, no_skip; ///< of the same, no_skip has only the cases
    };

    Side make_side(const Chain& chain, const std::string& name);
    std::size_t scene_case(const std::vector<std::string>& attachments);
    Row row_of(const Pair& pair, bool gpu) const;
    Frame frame_of(const Side& side, const ChainRunner& runner, bool gpu) const;

    SceneRenderers scenes_;
    SceneFacts facts_;
    PlanOptions options_;
    FrameInputs frame_;
    PlainPass copy_;
    std::vector<Case> cases_; ///< copy pass, scene alone, then what was added
    std::vector<std::pair<std::vector<std::string>, std::size_t>> scene_cases_;
    std::vector<Pair> pairs_;
    Result result_;
};

/// {"name", "same", "as_is": {"ms", "chain_ms", "copies", "texture_bytes", "attachments"}, "no_skip": the same, "saved":
/// {"ms", "p10", "p90", "copies", "texture_bytes"}}
nlohmann::ordered_json skip_json(const SkipComparison::Row& row, double copy_ms);

} // namespace postfx::host
