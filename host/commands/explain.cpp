// postfx explain: the plan, without drawing the chain; with --measure, what the frame decides and what skipping saves.
#include "command.hpp"
#include "options.hpp"
#include "scene_options.hpp"

#include "budget/met_budget.hpp"
#include "measure/level_trial.hpp"
#include "measure/skip_comparison.hpp"
#include "run/gl_session.hpp"
#include "run/picture_file.hpp"
#include "run/scene_view.hpp"
#include "terminal/progress_bar.hpp"

#include <postfx/postfx.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace postfx::host {
namespace {

class ExplainCommand : public Command {
public:
    void declare(CLI::App& app) override {
        scene_options_.declare(app);
        chain_options_.declare(app);
        catalog_options_.declare(app);
        app.add_option("-o,--output", output_, "Plan for this file's kind: .png for display, others linear")
            ->capture_default_str()
            ->type_name("FILE");
        app.add_flag("--measure", measure_,
                     "Draw scene and chain in turns with what --no-skip does, and tell what skipping saves");
        app.add_option("--samples", samples_, "Rounds of --measure; each draws both once")
            ->check(CLI::Range(3, 100000))
            ->capture_default_str();
        app.add_flag("--json", json_, "As JSON");
        app.add_option("--shader", shader_, "Print the generated shader of this pass instead")
            ->type_name("PASS");
    }

    Status run() override {
        if (measure_ && chain_options_.no_skip())
            throw Error("--measure compares with --no-skip: give one of them");
        if (measure_ && !shader_.empty()) throw Error("--shader prints nothing else: leave --measure out");
        const Catalog catalog = catalog_options_.load();
        Chain chain = chain_options_.read(catalog);
        const Scene scene = scene_options_.open();
        ViewBounds bounds(scene);
        const SceneFacts facts = scene_options_.facts(scene, bounds);
        const PlanOptions options = scene_options_.plan_options(output_for({output_}));
        // Drawn is only for --measure, and to meet a budget.
        std::optional<GlSession> session;
        if (measure_ || chain.budget) session.emplace();
        const std::optional<MetBudget> budget = met_budget(chain, scene, facts, options);
        if (measure_) return tell_measured(chain, scene, facts, options, budget, session->device().renderer);
        const Plan plan = Planner().plan(chain, facts, options);
        if (!shader_.empty()) return print_shader(plan);
        const std::string clock = "none: explain measures only with --measure";
        if (json_) {
            fmt::print("{}\n", with_budget(plan_json(plan, clock), budget).dump(2));
        } else {
            fmt::print("{}{}", plan_text(plan, clock), budget ? budget->text() : "");
        }
        return Status::success;
    }

private:
    std::optional<MetBudget> met_budget(Chain& chain, const Scene& scene, const SceneFacts& facts,
                                        const PlanOptions& options) const {
        if (!chain.budget) return std::nullopt;
        SceneRenderer renderer(scene);
        return meet_budget(chain, facts, options, chain_options_.budget_source(),
                           trial_inputs(renderer, facts, scene_options_.time()));
    }

    static nlohmann::ordered_json with_budget(const std::string& report_or_plan,
                                              const std::optional<MetBudget>& budget) {
        nlohmann::ordered_json json = nlohmann::ordered_json::parse(report_or_plan);
        if (budget) json["budget"] = nlohmann::ordered_json::parse(budget->json());
        return json;
    }

    Status tell_measured(const Chain& chain, const Scene& scene, const SceneFacts& facts,
                         const PlanOptions& options, const std::optional<MetBudget>& budget,
                         const std::string& device) const {
        SkipComparison study(scene, facts, options, scene_options_.time());
        study.add("chain", chain);
        {
            ProgressBar progress("measuring", samples_ + warm_up_rounds);
            study.measure(samples_, progress);
        }
        const SkipComparison::Result& result = study.result();
        const SkipComparison::Row& row = result.rows.front();
        if (json_) {
            nlohmann::ordered_json json = with_budget(report_json(row.report), budget);
            json["measured"] = {{"device", device}, {"rounds", result.rounds}, {"copy_ms", result.copy_ms}};
            json["measured"].update(skip_json(row, result.copy_ms));
            fmt::print("{}\n", json.dump(2));
        } else {
            fmt::print("{}{}{}", report_text(row.report), budget ? budget->text() : "",
                       text_of(result, device));
        }
        return Status::success;
    }

    static std::string text_of(const SkipComparison::Result& result, const std::string& device) {
        const SkipComparison::Row& row = result.rows.front();
        std::string text =
            fmt::format("\nscene and chain, median of {} rounds on {}\n", result.rounds, device);
        if (row.same) {
            return text
                   + fmt::format(
                       "  as it is  {:8.2f} ms  {:>7} MiB\nnothing is skipped: --no-skip is the same\n",
                       row.as_is.ms, mebibytes_text(static_cast<std::int64_t>(row.as_is.texture_bytes)));
        }
        for (const auto& [name, frame] :
             {std::pair{"as it is", &row.as_is}, std::pair{"no skip", &row.no_skip}}) {
            text += fmt::format("  {:<8}  {:8.2f} ms  {:>7} MiB  reads {}\n", name, frame->ms,
                                mebibytes_text(static_cast<std::int64_t>(frame->texture_bytes)),
                                fmt::join(frame->attachments, ", "));
        }
        return text
               + fmt::format("skipping saves {:.2f} ms ({:.2f} to {:.2f}; {:.1f} copies) and {} MiB\n",
                             row.saved_ms, row.saved_p10, row.saved_p90, row.saved_ms / result.copy_ms,
                             mebibytes_text(row.saved_bytes()));
    }

    Status print_shader(const Plan& plan) const {
        std::vector<std::string> names;
        for (const Pass& pass : plan.passes) {
            if (pass.name == shader_) {
                for (std::size_t i = 0; i < pass.program->files.size(); ++i) {
                    fmt::print("// source string {}: {}\n", i, pass.program->files[i]);
                }
                fmt::print("{}", pass.program->text);
                return Status::success;
            }
            names.push_back(pass.name);
        }
        throw Error(fmt::format("the plan has no pass \"{}\"{}; there are: {}", shader_,
                                did_you_mean(shader_, names), fmt::join(names, ", ")));
    }

    SceneOptions scene_options_;
    ChainOptions chain_options_{"cinematic"};
    CatalogOptions catalog_options_;
    std::string output_ = "picture.png", shader_;
    int samples_ = 21;
    bool json_ = false, measure_ = false;
};

const Register<ExplainCommand> registered("explain", "Tell what a chain would do, and why");

} // namespace
} // namespace postfx::host
