// postfx bench: what chains cost, measured alternately in one run and told in copy passes.
#include "command.hpp"
#include "options.hpp"
#include "scene_options.hpp"

#include "budget/met_budget.hpp"
#include "measure/level_trial.hpp"
#include "measure/measure.hpp"
#include "run/chain_runner.hpp"
#include "run/gl_session.hpp"
#include "run/resources.hpp"
#include "run/scene_view.hpp"
#include "terminal/progress_bar.hpp"

#include <base/read_file.hpp>
#include <image/metrics.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace postfx::host {
namespace {

constexpr std::size_t max_shader_bytes = std::size_t{1} << 20;

nlohmann::ordered_json spread(const std::vector<double>& samples) {
    return {{"median", median(samples)}, {"p10", quantile(samples, 0.1)}, {"p90", quantile(samples, 0.9)}};
}

class BenchCommand : public Command {
public:
    void declare(CLI::App& app) override {
        scene_options_.declare(app);
        app.add_option("--chain", chains_,
                       "Chain to measure, by name or file (repeatable; default cinematic)")
            ->type_name("CHAIN")
            ->default_str("")
            ->allow_extra_args(false);
        app.add_option(
               "--against", rivals_,
               "A whole fragment shader to measure beside them; it reads u_color (binding 0, or 1 for linear "
               "filtering) and writes location 0 (repeatable)")
            ->type_name("GLSL")
            ->default_str("")
            ->allow_extra_args(false);
        app.add_flag("--unfused", unfused_, "Measure every chain without fusion as well");
        app.add_flag("--folded", folded_,
                     "Also measure the chains with all values compiled in, as a game would ship them");
        app.add_flag("--no-skip", no_skip_,
                     "Measure every chain with every enabled effect run, called for or not, as well");
        declare_former_flag(app, "--run-all", "--no-skip", no_skip_);
        app.add_flag("--watch-nonfinite", watch_, "Measure every chain while it is watched for NaN as well");
        app.add_flag("--passes", passes_, "Tell every pass of the chains as well");
        app.add_flag("--with-scene", with_scene_,
                     "Draw the scene in every sample, as a frame would, with what the chain reads");
        app.add_option("--samples", samples_, "Rounds; each measures everything once, in random order")
            ->check(CLI::Range(3, 100000))
            ->capture_default_str();
        app.add_option("--format", format_, "Of working targets and the copy pass")
            ->check(CLI::IsMember({"rgba16f", "rgba32f"}))
            ->capture_default_str();
        app.add_flag("--linear", linear_, "Measure without output encoding");
        app.add_flag("--json", json_, "As JSON");
        catalog_options_.declare(app);
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        const Scene scene = scene_options_.open();
        ViewBounds bounds(scene);
        facts_ = scene_options_.facts(scene, bounds);
        plan_options_ = scene_options_.plan_options(linear_ ? Output::linear : Output::display);
        plan_options_.working_format = *format_by_name(format_);
        const GlSession session;
        SceneRenderers scenes(scene, facts_.width, facts_.height, scene_options_.time());
        frame_.camera = facts_.camera;
        frame_.time = scene_options_.time();
        make_runners(catalog, scenes);
        textures_ = textures_of(scenes.draw(wanted_attachments()));

        std::vector<Case> cases = make_cases(scenes);
        {
            ProgressBar progress("measuring", samples_ + warm_up_rounds);
            measure(cases, samples_, progress, [this] {
                if (passes_) measure_passes();
            });
        }
        for (Case& row : pass_rows_)
            cases.push_back(std::move(row));
        tell(cases, gl::check_clock(), session.device());
        return Status::success;
    }

private:
    struct NamedRunner {
        std::string name;
        std::unique_ptr<ChainRunner> runner;
    };

    void make_runners(const Catalog& catalog, SceneRenderers& scenes) {
        const TrialInputs tried_on = {[&](const std::vector<std::string>& attachments) {
                                          return textures_of(scenes.draw(attachments));
                                      },
                                      frame_};
        if (chains_.empty()) chains_.emplace_back("cinematic");
        for (const std::string& name : chains_) {
            Chain chain = read_chain_named(name, catalog);
            if (std::optional<MetBudget> budget = meet_budget(chain, facts_, plan_options_, {}, tried_on))
                budgets_.emplace_back(name, std::move(*budget));
            const auto add = [&](const std::string& variant, const PlanOptions& options) {
                runners_.push_back({name + variant, std::make_unique<ChainRunner>(chain, facts_, options)});
            };
            add("", plan_options_);
            PlanOptions other = plan_options_;
            other.fuse = false;
            if (unfused_) add(" (unfused)", other);
            other = plan_options_;
            other.fold = true;
            if (folded_) add(" (folded)", other);
            chain.skip = Skip::nothing;
            if (no_skip_) add(" (no skip)", plan_options_);
        }
    }

    std::vector<std::string> wanted_attachments() const {
        std::vector<std::string> wanted = {"color"};
        for (const NamedRunner& named : runners_) {
            for (const std::string& name : named.runner->attachments()) {
                if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
            }
        }
        return wanted;
    }

    std::vector<Case> make_cases(SceneRenderers& scenes) {
        const GLuint color = textures_.at("color");
        std::vector<Case> cases;
        const auto pass_of = [this](Format format, const std::string& fragment, const std::string& name) {
            return std::make_shared<PlainPass>(facts_.width, facts_.height, format, fragment, name);
        };
        const auto copy = std::make_shared<PlainPass>(
            PlainPass::copy(facts_.width, facts_.height, plan_options_.working_format));
        cases.push_back({"copy pass", [copy, color] { copy->draw(color); }});
        if (with_scene_) cases.push_back(framed({"scene alone", [] {}}, scenes, {}));
        for (const std::string& rival : rivals_) {
            const auto pass = pass_of(linear_ ? plan_options_.working_format : Format::rgba8,
                                      read_file(rival, max_shader_bytes, "a fragment shader"), rival);
            cases.push_back(framed({rival, [pass, color] { pass->draw(color); }}, scenes, {}));
            compare_with_rival(*pass, rival);
        }
        for (const NamedRunner& named : runners_) {
            ChainRunner* runner = named.runner.get();
            const Textures textures =
                with_scene_ ? textures_of(scenes.draw(runner->attachments())) : textures_;
            const auto add = [&](const std::string& name, Watch watch) {
                Case drawn{name, [this, runner, textures, watch] {
                               runner->run(textures, frame_, Timing::off, watch);
                           }};
                drawn.texture_bytes = runner->plan().texture_bytes();
                cases.push_back(framed(std::move(drawn), scenes, runner->attachments()));
            };
            add(named.name, Watch::off);
            if (watch_) add(named.name + " (watched)", Watch::nonfinite);
        }
        return cases;
    }

    /// With --with-scene the same behind the scene, drawn with these attachments.
    Case framed(Case drawn, SceneRenderers& scenes, const std::vector<std::string>& attachments) const {
        if (!with_scene_) return drawn;
        drawn.texture_bytes += scenes.draw(attachments).texture_bytes;
        drawn.draw = [&scenes, attachments, draw = std::move(drawn.draw)] {
            scenes.draw(attachments);
            draw();
        };
        return drawn;
    }

    /// A rival that draws another picture measures nothing: tell how far it is from the first chain's.
    void compare_with_rival(const PlainPass& pass, const std::string& name) {
        pass.draw(textures_.at("color"));
        runners_.front().runner->run(textures_, frame_, Timing::off);
        const Difference difference =
            compare(pass.picture(), runners_.front().runner->executor().read_picture());
        const std::size_t pixels = static_cast<std::size_t>(facts_.width) * facts_.height;
        rival_notes_.push_back(
            fmt::format("{} and {} differ by at most {:.4f} in {:.3f} % of the pixels", name,
                        runners_.front().name, difference.max_abs,
                        100.0 * static_cast<double>(difference.differing) / static_cast<double>(pixels)));
    }

    void measure_passes() {
        std::size_t row = 0;
        for (const NamedRunner& named : runners_) {
            named.runner->run(textures_, frame_, Timing::profile);
            for (const PassReport& pass : named.runner->executor().report().passes) {
                if (row == pass_rows_.size()) {
                    pass_rows_.push_back({fmt::format("{}: {}", named.name, pass.name), {}});
                }
                pass_rows_[row].cpu_ms.push_back(*pass.cpu_ms);
                pass_rows_[row].wall_ms.push_back(*pass.wall_ms);
                ++row;
            }
        }
    }

    void tell(const std::vector<Case>& cases, const gl::ClockCheck& clock,
              const gl::DeviceInfo& device) const {
        const bool gpu = clock.timer_queries_honest;
        const auto unit_of = [&](const Case& row) { return median(row.times(gpu)); };
        const double copy = unit_of(cases.front());
        const std::string clock_text = gpu ? clock.text : "CPU time of all threads; " + clock.text;
        if (json_) {
            nlohmann::ordered_json json = {
                {"device", device.renderer}, {"clock", clock_text},
                {"width", facts_.width},     {"height", facts_.height},
                {"format", format_},         {"samples", samples_},
                {"rivals", rival_notes_},    {"rows", nlohmann::ordered_json::array()}};
            for (const auto& [name, budget] : budgets_)
                json["budgets"][name] = nlohmann::ordered_json::parse(budget.json());
            for (const Case& row : cases) {
                nlohmann::ordered_json item = {
                    {"name", row.name}, {"cpu_ms", spread(row.cpu_ms)}, {"wall_ms", spread(row.wall_ms)}};
                if (gpu && !row.gpu_ms.empty()) item["gpu_ms"] = spread(row.gpu_ms);
                item["copies"] = unit_of(row) / copy;
                item["texture_bytes"] = nullptr;
                if (row.texture_bytes > 0) item["texture_bytes"] = row.texture_bytes;
                json["rows"].push_back(std::move(item));
            }
            fmt::print("{}\n", json.dump(2));
            return;
        }
        std::size_t width = 4;
        for (const Case& row : cases)
            width = std::max(width, row.name.size());
        fmt::print("{}x{} {}, {} rounds on {}\nclock: {}\n\n{:<{}}  {:>9}  {:>19}  {:>9}  {:>7}  {:>12}\n",
                   facts_.width, facts_.height, format_, samples_, device.renderer, clock_text, "", width,
                   gpu ? "gpu ms" : "cpu ms", "p10 - p90", "wall ms", "copies", "textures MiB");
        for (const Case& row : cases) {
            const std::vector<double>& times = row.times(gpu);
            const std::string mebibytes =
                row.texture_bytes > 0 ? mebibytes_text(static_cast<std::int64_t>(row.texture_bytes)) : "";
            fmt::print("{:<{}}  {:9.2f}  {:>8.2f} - {:<8.2f}  {:9.2f}  {:7.2f}  {:>12}\n", row.name, width,
                       median(times), quantile(times, 0.1), quantile(times, 0.9), median(row.wall_ms),
                       unit_of(row) / copy, mebibytes);
        }
        for (const std::string& note : rival_notes_)
            fmt::print("{}\n", note);
        for (const auto& [name, budget] : budgets_)
            fmt::print("\n{}, {}", name, budget.text());
    }

    SceneOptions scene_options_{"night_drive"};
    CatalogOptions catalog_options_;
    std::vector<std::string> chains_, rivals_;
    std::string format_ = "rgba16f";
    int samples_ = 21;
    bool unfused_ = false, folded_ = false, watch_ = false, passes_ = false, with_scene_ = false,
         no_skip_ = false, linear_ = false, json_ = false;

    SceneFacts facts_;
    PlanOptions plan_options_;
    FrameInputs frame_;
    Textures textures_;
    std::vector<NamedRunner> runners_;
    std::vector<std::pair<std::string, MetBudget>> budgets_; ///< of the chains that have one, by name
    std::vector<Case> pass_rows_;
    std::vector<std::string> rival_notes_;
};

const Register<BenchCommand> registered("bench", "Measure what chains cost, in copy passes");

} // namespace
} // namespace postfx::host
