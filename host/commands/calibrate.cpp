// postfx calibrate: what levels cost on this device; how far they are from truths is known already.
#include "command.hpp"
#include "options.hpp"

#include "budget/device_curves.hpp"
#include "input/open_scene.hpp"
#include "run/gl_session.hpp"
#include "run/resources.hpp"
#include "study/engine/times.hpp"
#include "study/engine/view.hpp"
#include "study/fit.hpp"
#include "study/spec.hpp"
#include "terminal/interruption.hpp"
#include "terminal/text_table.hpp"

#include <build_commit.hpp>
#include <gl/clock.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

namespace postfx::host {
namespace {

class CalibrateCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_flag("--quick", quick_, "Small pictures of one scene per effect, few rounds: a rough answer");
        app.add_option("--rounds", rounds_, "Of measuring what is quick; what is slow gets fewer")
            ->check(CLI::Range(1, 100000))
            ->capture_default_str();
        app.add_option("--seconds", seconds_, "For measuring an effect once, in one scene at one size")
            ->check(CLI::Range(0.1, 1e6))
            ->capture_default_str();
        app.add_option("--curves", curves_, "Errors are from this file; from what comes along without")
            ->type_name("FILE.json")
            ->default_str("");
        app.add_option("-o,--output", output_, "Instead of the user's cache")
            ->type_name("FILE.json")
            ->default_str("");
        app.add_flag("--json", json_, "Tell the curves as they are written");
        catalog_options_.declare(app);
        app.footer(
            "Budgets (`budget:` in a chain, --budget) are met by these times from then on, on this device "
            "with this driver.\n"
            "Every effect is measured alone in a chain, in the scenes and with the values that "
            "`postfx study` has.");
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        const study::Spec spec = study::Spec::read(data_directory() / "configs/study.yaml");
        const GlSession session;
        const FoundCurves known =
            curves_.empty() ? shipped_curves(session.device()) : find_curves(std::filesystem::path(curves_));
        const std::filesystem::path file =
            output_.empty() ? kept_curves_file(session.device()) : std::filesystem::path(output_);
        const gl::ClockCheck clock = gl::check_clock();
        options_ = {.rounds = quick_ ? quick_rounds : rounds_,
                    .seconds = quick_ ? quick_seconds : seconds_,
                    .gpu = clock.timer_queries_honest};

        Curves measured;
        measured.device = session.device().renderer;
        measured.driver = session.device().version;
        measured.clock = options_.gpu ? clock.text : "CPU time of all threads; " + clock.text;
        measured.made_by = fmt::format("{}, postfx {} ({}); errors: {}", command(), POSTFX_VERSION,
                                       POSTFX_COMMIT, known.curves.made_by);
        const StopOnInterrupt guard;
        try {
            for (const auto& [effect, levels] : known.curves.effects) {
                const EffectPtr found = catalog.find(effect);
                if (!found) {
                    fmt::print(stderr, "postfx: {} has curves, but was not found: left out\n", effect);
                    continue;
                }
                const study::EffectSpec studied = spec.of(*found);
                measured.effects[effect] =
                    timed(study::entry_of(catalog, effect, studied), levels, studied.scenes);
            }
        } catch (const Interrupted&) {
            fmt::print(stderr, "postfx: stopped; nothing was written\n");
            return Status::interrupted;
        }
        measured.base = study::fit_time(base_);
        write_curves(file, measured);
        tell(measured, known.curves, file);
        return Status::success;
    }

private:
    static constexpr int quick_rounds = 3;
    static constexpr double quick_seconds = 2;

    std::string command() const {
        return quick_ ? "postfx calibrate --quick"
                      : fmt::format("postfx calibrate --rounds {} --seconds {}", rounds_, seconds_);
    }

    std::vector<Size> sizes() const {
        if (quick_) return {{320, 180}, {160, 90}};
        return {{1280, 720}, {640, 360}};
    }

    /// The levels with their times on this device.
    std::vector<LevelCurve> timed(const ChainEntry& entry, std::vector<LevelCurve> levels,
                                  std::vector<std::string> scenes) {
        const EffectInfo& effect = *entry.effect;
        if (quick_) scenes.resize(1);
        std::vector<ChainEntry> entries;
        for (const LevelCurve& level : levels) {
            const auto found = std::find_if(effect.levels.begin(), effect.levels.end(),
                                            [&](const LevelInfo& info) { return info.id == level.level; });
            if (found == effect.levels.end() && !level.level.empty())
                throw Error(
                    fmt::format("{} has no level \"{}\", of which there is a curve", effect.id, level.level));
            entries.push_back(entry);
            if (!level.level.empty()) entries.back().level = static_cast<int>(found - effect.levels.begin());
        }
        std::vector<study::Points> points(levels.size());
        for (const std::string& name : scenes) {
            for (const Size& size : sizes()) {
                const study::View view(scene(name), effect, size, 1);
                const study::TimedEntries costs = study::measure_entries(
                    view, entries, options_,
                    fmt::format("{} in {} at {}x{}", effect.id, name, size.width, size.height));
                base_.emplace_back(1e-6 * size.width * size.height, costs.base_ms.median);
                for (std::size_t i = 0; i < levels.size(); ++i)
                    points[i].emplace_back(costs.costs[i].megapixels(), costs.costs[i].ms.median);
            }
        }
        for (std::size_t i = 0; i < levels.size(); ++i)
            levels[i].time = study::fit_time(points[i]);
        return levels;
    }

    study::StudyScene& scene(const std::string& name) {
        std::unique_ptr<study::StudyScene>& found = scenes_[name];
        if (!found) found = std::make_unique<study::StudyScene>(open_known_scene(name));
        return *found;
    }

    void tell(const Curves& measured, const Curves& known, const std::filesystem::path& file) const {
        if (json_) {
            fmt::print("{}", curves_json(measured));
            return;
        }
        constexpr double full_hd = 1.920 * 1.080;
        fmt::print("on {}, {}\nclock: {}\n\n", measured.device, measured.driver, measured.clock);
        std::vector<std::vector<std::string>> rows = {
            {"", "", "ms at 1920x1080", "ms at 1 megapixel", "ms fixed", "error", "ms by the curves before"}};
        const auto add = [&](const std::string& effect, const std::string& level, const TimeCurve& time,
                             const std::string& error, const TimeCurve& before) {
            rows.push_back({effect, level, fmt::format("{:.3f}", time.at(full_hd)),
                            fmt::format("{:.3f}", time.at(1)), fmt::format("{:.3f}", time.fixed_ms), error,
                            fmt::format("{:.3f}", before.at(full_hd))});
        };
        add("no effect", "", measured.base, "", known.base);
        for (const auto& [effect, levels] : measured.effects) {
            for (const LevelCurve& level : levels) {
                add(effect, level.level, level.time, fmt::format("{:.3g}", level.error),
                    known.find(effect, level.level)->time);
            }
        }
        fmt::print("{}\nwrote {}\n", text_table(rows, 0), file.string());
    }

    CatalogOptions catalog_options_;
    std::string curves_, output_;
    int rounds_ = 11;
    double seconds_ = 10;
    bool quick_ = false, json_ = false;

    study::TimeOptions options_;
    std::map<std::string, std::unique_ptr<study::StudyScene>> scenes_;
    study::Points base_; ///< of chains without effects: megapixels, ms
};

const Register<CalibrateCommand> registered("calibrate", "Measure on this device what a budget buys");

} // namespace
} // namespace postfx::host
