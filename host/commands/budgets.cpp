// postfx budgets: is it worth to ask for a budget? Chosen levels against one level for all, on scenes.
#include "command.hpp"
#include "options.hpp"

#include "budget/device_curves.hpp"
#include "input/open_scene.hpp"
#include "measure/truth_store.hpp"
#include "run/gl_session.hpp"
#include "run/resources.hpp"
#include "run/scene_view.hpp"
#include "study/engine/budget_proof.hpp"
#include "terminal/interruption.hpp"

#include <image/files.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace postfx::host {
namespace {

using study::BudgetProof;
using study::ProvedBudget;
using study::ProvedSetting;

/// Light in the scene and the lens: behind the tone map errors are of codes, and of noise there is no picture.
Chain scene_referred(Chain chain, std::vector<std::string>& left_out) {
    std::vector<ChainEntry> kept;
    for (ChainEntry& entry : chain.entries) {
        if (entry.effect->stage == EffectStage::scene) {
            kept.push_back(std::move(entry));
        } else {
            left_out.push_back(entry.name);
        }
    }
    chain.entries = std::move(kept);
    return chain;
}

std::string setting_row(const ProvedSetting& setting, double time_scale) {
    return fmt::format("| {} | {:.1f} | {:.1f} ({:.1f}–{:.1f}) | {:.3f} | {:.4f} |\n", setting.name,
                       setting.predicted_ms * time_scale, setting.ms.median, setting.ms.p10, setting.ms.p90,
                       setting.predicted_error, setting.error);
}

std::string budget_row(const ProvedBudget& budget, const BudgetProof& proof) {
    const ProvedSetting& chosen = proof.settings[budget.chosen];
    std::string text = fmt::format("| {:.1f} | {} | {:.1f} | {:.4f} |", budget.ms, chosen.name,
                                   chosen.ms.median, chosen.error);
    if (!budget.uniform) return text + " none | | |\n";
    const ProvedSetting& uniform = proof.settings[*budget.uniform];
    return text
           + fmt::format(" {} | {:.4f} | {:.2f} |\n", uniform.name, uniform.error,
                         budget.ratio(proof.settings));
}

std::string section_of(const BudgetProof& proof) {
    std::string text = fmt::format("\n## {}\n\n", proof.scene);
    text += fmt::format("Of {} budgets that one level for all fits too, choosing is at least 20 % closer to "
                        "the truth in {}, and more than 2 % "
                        "farther in {}. The chain takes {:.2f} times as long as its curves say. Truth: {}; "
                        "its own error is {:.2g}.\n\n",
                        proof.compared(), proof.at_most(0.8), proof.worse_than(1.02), proof.time_scale,
                        fmt::join(proof.truths, ", "), proof.truth_own_error);
    text += "| Budget [ms] | Chosen | ms | Error | Best of one level for all | Error | Ratio |\n"
            "|--:|---|--:|--:|---|--:|--:|\n";
    for (const ProvedBudget& budget : proof.budgets)
        text += budget_row(budget, proof);
    text += "\n| Setting | Predicted [ms] | Measured [ms], p10–p90 | Predicted error | Error |\n"
            "|---|--:|--:|--:|--:|\n";
    for (const ProvedSetting& setting : proof.settings)
        text += setting_row(setting, proof.time_scale);
    return text;
}

class BudgetsCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("SCENE", scenes_, "Names from configs/scenes/, scene files or models")
            ->default_str("still_life cornell");
        app.add_option("--chain", chain_, "By name or file; its effects from the tone map on are left out")
            ->type_name("CHAIN")
            ->capture_default_str();
        app.add_option("--curves", curves_,
                       "What levels cost, as `postfx study` writes it; this device's without")
            ->type_name("FILE")
            ->default_str("");
        app.add_option("--size", size_, "Of the picture, pixels")->type_name("WxH")->capture_default_str();
        app.add_option("--levels", options_.uniform_levels, "Levels that are tried for all effects at once")
            ->default_str("low medium high ultra");
        app.add_option("--budgets", options_.budgets, "How many, from the quickest to the slowest of these")
            ->check(CLI::Range(2, 100))
            ->capture_default_str();
        app.add_option("--samples", options_.rounds, "Rounds; each draws everything of a scene once")
            ->check(CLI::Range(3, 100000))
            ->capture_default_str();
        app.add_option("--store", store_, "Where truths are kept; truths/ in the user's cache without")
            ->type_name("DIR")
            ->default_str("");
        app.add_option("-o,--output", output_, "Write the page here instead of to the terminal")
            ->type_name("FILE");
        app.add_flag("--json", json_, "As JSON");
        catalog_options_.declare(app);
        app.footer(
            "For budgets from tight to loose, the levels that the budget chooses are compared with every\n"
            "setting of one level for all that fits the same time, both against the truth of the chain.\n"
            "Times are measured in turns in one run. Errors are relative RMSE of linear light.\n"
            "Status: 0 done, 2 bad input, 130 stopped; truths that were begun go on from there.");
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        std::vector<std::string> left_out;
        const Chain chain = scene_referred(read_chain_named(chain_, catalog), left_out);
        options_.size = parse_size(size_);
        const GlSession session;
        const FoundCurves curves = find_curves(curves_);
        std::vector<BudgetProof> proofs;
        const StopOnInterrupt guard;
        try {
            for (const std::string& scene : scenes_.empty() ? default_scenes() : scenes_) {
                study::StudyScene opened(open_known_scene(scene));
                proofs.push_back(
                    study::prove_budgets(opened, chain, curves.curves, options_, truth_store(store_)));
            }
        } catch (const Interrupted&) {
            return Status::interrupted;
        }
        tell(json_ ? json_of(proofs, session.device()) : page_of(proofs, session.device(), left_out));
        return Status::success;
    }

private:
    static std::vector<std::string> default_scenes() { return {"still_life", "cornell"}; }

    void tell(const std::string& text) const {
        if (output_.empty()) {
            fmt::print("{}", text);
        } else {
            write_file_atomically(output_, text);
            fmt::print("wrote {}\n", output_);
        }
    }

    std::string command() const {
        return fmt::format("postfx budgets{}{} --chain {} --size {} --budgets {} --samples {}",
                           scenes_.empty() ? "" : " ", fmt::join(scenes_, " "), chain_, size_,
                           options_.budgets, options_.rounds);
    }

    static std::string json_of(const std::vector<BudgetProof>& proofs, const gl::DeviceInfo& device) {
        nlohmann::ordered_json json = {{"device", device.renderer},
                                       {"proofs", nlohmann::ordered_json::array()}};
        for (const BudgetProof& proof : proofs)
            json["proofs"].push_back(study::budget_proof_json(proof));
        return json.dump(2) + "\n";
    }

    std::string page_of(const std::vector<BudgetProof>& proofs, const gl::DeviceInfo& device,
                        const std::vector<std::string>& left_out) const {
        std::string text = fmt::format(
            "<!-- Made by `{0}`. Not edited by hand. -->\n\n# Is it worth to ask for a budget?\n\n"
            "For budgets from tight to loose: the levels that `budget: {{ms: …}}` chooses, against one level "
            "for all effects that fits the same time. As in a running chain, levels are chosen by what they "
            "do in a trial in the scene, and again when it is known how long the choice takes. Errors "
            "are relative RMSE of linear light against the truth of the "
            "whole chain.\n\n"
            "Made by `{0}` on {1}. Clock: {2}. Medians of {3} rounds in which everything was drawn in "
            "turns.{4}\n",
            command(), device.renderer, proofs.front().clock, options_.rounds,
            left_out.empty()
                ? std::string()
                : fmt::format(" Left out of the chain, since they stand from the tone map on: {}.",
                              fmt::join(left_out, ", ")));
        for (const BudgetProof& proof : proofs)
            text += section_of(proof);
        return text;
    }

    CatalogOptions catalog_options_;
    study::BudgetProofOptions options_;
    std::vector<std::string> scenes_;
    std::string chain_ = "default", curves_, size_ = "640x360", store_, output_;
    bool json_ = false;
};

const Register<BudgetsCommand> registered("budgets", "Tell what asking for a budget is worth");

} // namespace
} // namespace postfx::host
