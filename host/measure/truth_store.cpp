#include "truth_store.hpp"

#include "run/resources.hpp"
#include "terminal/interruption.hpp"
#include "terminal/progress_bar.hpp"

#include <gl/clock.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

namespace fs = std::filesystem;

namespace postfx::host {

fs::path truth_store(const std::string& folder) {
    if (folder.empty() && cache_directory().empty())
        throw Error("there is no home for a cache; name a folder for the sums with --store");
    fs::path store = folder.empty() ? cache_directory() / "truths" : fs::path(folder);
    std::error_code error;
    fs::create_directories(store, error);
    if (error) throw Error(Place{.file = store.string()}, fmt::format("can't be made: {}", error.message()));
    return store;
}

void sum_up(TruthRun& run, const fs::path& file, const std::string& what) {
    constexpr double seconds_between_saves = 20; // so that not even a crash costs more than that
    if (run.complete()) return;
    ProgressBar progress(what, run.samples() - run.done());
    int kept = run.done();
    double saved = gl::HostTime::now().wall_ms;
    while (!run.complete() && !StopOnInterrupt::asked()) {
        run.step();
        progress.advance();
        if (gl::HostTime::now().wall_ms - saved > 1000 * seconds_between_saves) {
            run.save(file);
            kept = run.done();
            saved = gl::HostTime::now().wall_ms;
        }
    }
    if (run.done() > kept) run.save(file);
}

} // namespace postfx::host
