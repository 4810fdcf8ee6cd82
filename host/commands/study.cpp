// postfx study: what accuracy costs in time, of every level of every effect.
#include "command.hpp"
#include "options.hpp"

#include "measure/truth_store.hpp"
#include "run/gl_session.hpp"
#include "run/resources.hpp"
#include "run/scene_view.hpp"
#include "study/engine/study.hpp"
#include "study/output.hpp"
#include "study/sentences.hpp"
#include "study/tables.hpp"
#include "terminal/interruption.hpp"
#include "terminal/text_table.hpp"

#include <build_commit.hpp>
#include <gl/clock.hpp>
#include <image/flip.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace postfx::host {
namespace {

class StudyCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("EFFECT", effects_, "Effects to study (default: all that are found)")->default_str("");
        app.add_option(
               "--scene", scenes_,
               "Instead of those of the effect's study.yaml: a name from configs/scenes/, a scene file or a "
               "model (repeatable)")
            ->type_name("SCENE")
            ->default_str("")
            ->allow_extra_args(false);
        app.add_option(
               "--size", size_,
               "Of pictures that are compared with truths, pixels; without, as the effect's study.yaml says, "
               "or 480x270")
            ->type_name("WxH")
            ->default_str("");
        app.add_option("--time-size", time_size_, "Of pictures whose time is measured, pixels")
            ->type_name("WxH")
            ->capture_default_str();
        app.add_option("--small-time-size", small_time_size_,
                       "Also measured, for how time grows with the picture")
            ->type_name("WxH")
            ->capture_default_str();
        app.add_option("-o,--output", output_, "Folder for what is written")
            ->type_name("DIR")
            ->capture_default_str();
        app.add_option("--rounds", rounds_, "Of measuring what is quick; what is slow gets fewer")
            ->check(CLI::Range(1, 100000))
            ->capture_default_str();
        app.add_option("--seconds", seconds_,
                       "For measuring an effect's times once, in one scene at one size")
            ->check(CLI::Range(0.1, 1e6))
            ->capture_default_str();
        app.add_option("--samples", samples_,
                       "Of truths, an even number: few make them quick and coarse; each truth's own default "
                       "without")
            ->check(CLI::Range(2, 1 << 24))
            ->type_name("N")
            ->default_str("");
        app.add_flag("--no-growth", no_growth_, "Leave out how time and error grow with radius and pixels");
        app.add_option("--growth-seconds", growth_seconds_,
                       "Levels of which one draw takes longer are left out of their growth")
            ->check(CLI::Range(0.001, 1e6))
            ->capture_default_str();
        app.add_option("--spec", spec_,
                       "What is studied of effects, before their own study.yaml; configs/study.yaml without")
            ->type_name("FILE")
            ->default_str("");
        app.add_option("--store", store_,
                       "Where sums of truths are kept; truths/ in the user's cache without")
            ->type_name("DIR")
            ->default_str("");
        app.add_flag("--json", json_, "Tell what study.json holds instead of sentences");
        catalog_options_.declare(app);
        app.footer(
            "Every level of an effect, alone in a chain, on every scene: how far its picture is from the "
            "truths that there\n"
            "are (relative RMSE of light; LDR-FLIP of x / (1 + x), 67 pixels per degree; the effect's own "
            "metrics), what it\n"
            "adds to a chain in time (median, p10 and p90 of rounds in which all levels are drawn in turns), "
            "and how both\n"
            "grow. An effect without a truth, such as your own, gets times only.\n"
            "DIR/index.html holds all of it; study.csv, metrics.csv, growth.csv and study.json hold the "
            "numbers, curves.json\n"
            "what a budget chooses from, *.svg and pictures/ what the page shows. They are written anew "
            "after "
            "every effect:\n"
            "what is finished is kept when a later one fails or Ctrl-C stops it. Truths go on where they "
            "were "
            "stopped.\n"
            "Status: 0 done, 2 bad input or an effect that failed, 130 stopped.");
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        const std::vector<EffectPtr> effects = chosen(catalog);
        study::StudyOptions options = read_options();
        study::Spec spec = study::Spec::read(spec_.empty() ? data_directory() / "configs/study.yaml"
                                                           : std::filesystem::path(spec_));
        const GlSession session;
        const gl::ClockCheck clock = gl::check_clock();
        options.times.gpu = clock.timer_queries_honest;

        study::Findings findings;
        findings.conditions = conditions(session.device(), clock);
        const StopOnInterrupt guard;
        study::Study study(catalog, std::move(spec), std::move(options));
        bool stopped = false;
        for (const EffectPtr& effect : effects) {
            try {
                findings.effects.push_back(study.run(*effect));
                if (!json_) tell(findings.effects.back());
            } catch (const Error& error) {
                findings.failures.push_back({effect->id, error.what()});
                fmt::print(stderr, "postfx: {} could not be studied: {}\n", effect->id, error.what());
            } catch (const Interrupted&) {
                stopped = true;
                findings.failures.push_back({effect->id, "was stopped"});
            }
            findings.base = study.base();
            written_ = study::write_study(output_, findings);
            if (stopped) break;
        }
        if (json_) fmt::print("{}\n", study::findings_json(findings).dump(2));
        return finish(findings, stopped, effects.size());
    }

private:
    std::vector<EffectPtr> chosen(const Catalog& catalog) const {
        if (effects_.empty()) return catalog.effects();
        std::vector<EffectPtr> effects;
        for (const std::string& id : effects_) {
            const EffectPtr effect = catalog.find(id);
            if (!effect)
                throw Error(fmt::format("no effect \"{}\"{} (postfx list effects tells them all)", id,
                                        did_you_mean(id, catalog.ids())));
            if (std::find(effects.begin(), effects.end(), effect) == effects.end()) effects.push_back(effect);
        }
        return effects;
    }

    study::StudyOptions read_options() const {
        if (samples_ % 2 != 0) throw Error(fmt::format("--samples {} is not an even number", samples_));
        study::StudyOptions options;
        if (!size_.empty()) options.picture = parse_size(size_);
        options.time_sizes = {parse_size(time_size_), parse_size(small_time_size_)};
        options.scenes = scenes_;
        options.truths.store = truth_store(store_);
        options.truths.samples = samples_;
        options.times.rounds = rounds_;
        options.times.seconds = seconds_;
        options.growth = !no_growth_;
        options.growth_seconds = growth_seconds_;
        return options;
    }

    /// What was typed, but for where things went.
    std::string command() const {
        std::vector<std::string> words = {"postfx study"};
        words.insert(words.end(), effects_.begin(), effects_.end());
        for (const std::string& scene : scenes_)
            words.push_back("--scene " + scene);
        if (!size_.empty()) words.push_back("--size " + size_);
        words.push_back(fmt::format("--time-size {} --small-time-size {} --rounds {} --seconds {}",
                                    time_size_, small_time_size_, rounds_, seconds_));
        if (samples_ > 0) words.push_back(fmt::format("--samples {}", samples_));
        words.push_back(no_growth_ ? "--no-growth" : fmt::format("--growth-seconds {}", growth_seconds_));
        return fmt::format("{}", fmt::join(words, " "));
    }

    study::Conditions conditions(const gl::DeviceInfo& device, const gl::ClockCheck& clock) const {
        study::Conditions conditions;
        conditions.program = fmt::format("postfx {} ({})", POSTFX_VERSION, POSTFX_COMMIT);
        conditions.command = command();
        conditions.device = device.renderer;
        conditions.driver = device.version;
        conditions.clock = clock.timer_queries_honest ? clock.text : "CPU time of all threads; " + clock.text;
        conditions.time_sizes = {time_size_, small_time_size_};
        conditions.pixels_per_degree = default_pixels_per_degree;
        conditions.working_format = format_info(Format::rgba16f).name;
        return conditions;
    }

    static void tell(const study::EffectFindings& effect) {
        for (const std::string& sentence : study::sentences_of(effect))
            fmt::print("{}", wrapped(sentence, 2));
        for (const std::string& note : effect.notes)
            fmt::print("{}", wrapped("(" + note + ")", 2));
        fmt::print("\n");
        std::fflush(stdout);
    }

    Status finish(const study::Findings& findings, bool stopped, std::size_t asked) const {
        if (!json_) fmt::print("wrote {}/: {}\n", output_, fmt::join(written_, ", "));
        if (stopped) {
            fmt::print(stderr, "postfx: stopped; {} of {} effects are written, truths go on where they are\n",
                       findings.effects.size(), asked);
            return Status::interrupted;
        }
        if (findings.failures.empty()) return Status::success;
        std::vector<std::string> failed;
        for (const study::Failure& failure : findings.failures)
            failed.push_back(failure.effect);
        throw Error(fmt::format("{} could not be studied (why is told above); the others are written",
                                fmt::join(failed, ", ")));
    }

    CatalogOptions catalog_options_;
    std::vector<std::string> effects_, scenes_, written_;
    std::string size_, time_size_ = "1280x720", small_time_size_ = "640x360", output_ = "study", store_,
                       spec_;
    int rounds_ = 11, samples_ = 0;
    double seconds_ = 30, growth_seconds_ = 1;
    bool no_growth_ = false, json_ = false;
};

const Register<StudyCommand>
    registered("study", "Measure what accuracy costs: error against truths and time, per level");

} // namespace
} // namespace postfx::host
