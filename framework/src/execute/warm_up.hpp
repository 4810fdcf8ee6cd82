// Programs compiled to the end on a second thread, in a context of its own, before anything is drawn with them.
//
// Software renderers put most of compiling off until the first draw, for what a draw depends on: formats, samplers,
// whether sides are powers of two. What they made lands in the driver's cache on disk, where the drawing context finds
// it; contexts share nothing else. So the passes are drawn once on either side: the warm-up goes through them from the
// last to the first, whoever draws from the first to the last, and where they meet it is over.
#pragma once

#include <execute/program_cache.hpp>
#include <gl/context.hpp>

#include <postfx/executor.hpp>
#include <postfx/plan.hpp>

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace postfx {

/// A texture in place of one that a pass reads.
struct StandIn {
    int width = 0, height = 0; ///< pixels
    Format format = Format::rgba16f;
};

/// Some passes of a plan, whatever their conditions, with targets and inputs of a few pixels each.
struct SmallPlan {
    Plan plan;
    std::vector<StandIn> inputs; ///< by index into plan.attachments
};

/// To compile for `passes` of `plan` what drawing them needs: formats and whether sides are powers of two stay.
/// `formats`: of the plan's attachments.
SmallPlan small_plan(const Plan& plan, const std::vector<std::size_t>& passes,
                     const std::vector<Format>& formats);

class WarmUp {
public:
    /// With a context of the current one's kind. `formats`: of the plan's attachments; `directory`: of linked programs.
    WarmUp(const Plan& plan, std::vector<Format> formats, std::filesystem::path directory);
    /// Waits for the program at hand, and no other.
    ~WarmUp();
    WarmUp(const WarmUp&) = delete;
    WarmUp& operator=(const WarmUp&) = delete;

    /// With the current context and a second core?
    static bool helps(const ProgramCache& programs);

    /// The caller draws this pass next: waits if its program is being compiled here, and else leaves it to the caller.
    void leave(std::size_t pass_index);
    /// Programs that were compiled here.
    int warmed();

private:
    /// All passes with one program.
    struct Unit {
        std::vector<std::size_t> passes;
        enum class State { open, busy, warmed, left } state = State::open;
    };

    void work();
    void compile(Executor& executor, const Unit& unit) const;
    std::optional<std::size_t> take_last();
    void put_back(std::size_t unit, Unit::State state);

    Plan plan_;
    std::vector<Format> formats_;
    std::filesystem::path directory_;
    gl::DeviceInfo device_;
    std::vector<std::size_t> unit_of_pass_;
    std::mutex mutex_; ///< guards the states of units
    std::condition_variable changed_;
    std::vector<Unit> units_; ///< in the order of drawing
    std::thread thread_;      ///< last: it uses all others
};

} // namespace postfx
