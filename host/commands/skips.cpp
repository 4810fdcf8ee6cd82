// postfx skips: which effects which scenes call for, why, and what it saves to leave out the others.
#include "command.hpp"
#include "options.hpp"

#include "input/open_scene.hpp"
#include "measure/skip_comparison.hpp"
#include "run/gl_session.hpp"
#include "run/resources.hpp"
#include "run/scene_view.hpp"
#include "terminal/number_checks.hpp"
#include "terminal/progress_bar.hpp"
#include "terminal/text_table.hpp"

#include <image/files.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// One scene's measurements: no effect at all, each effect alone, the whole chain.
struct SceneFindings {
    std::string name, description;
    SceneBounds bounds;
    SkipComparison::Result result;
};

std::string metres(double value) {
    return value == SceneBounds::infinity ? "infinity" : fmt::format("{:.4g} m", value);
}

std::string bounds_text(const SceneBounds& bounds) {
    const auto is_empty = [&](const char* name) {
        return std::find(bounds.empty.begin(), bounds.empty.end(), name) != bounds.empty.end();
    };
    std::string text = is_empty("depth") ? "Nothing but sky"
                                         : fmt::format("Surfaces between {} and {}", metres(bounds.nearest),
                                                       metres(bounds.farthest));
    if (!bounds.empty.empty()) text += fmt::format("; nothing in: {}", fmt::join(bounds.empty, ", "));
    return text + ".";
}

std::string_view moment_text(const PlannedEffect& effect) {
    return effect.moment ? moment_word(*effect.moment) : "";
}

std::string kind_text(const PlannedEffect& effect) {
    if (!effect.kind) return "";
    return effect.kind == SkipKind::lacks ? "lacks an input" : std::string(skip_kind_word(*effect.kind));
}

/// Which of the chain's effects were left out, and when.
std::string skipped_list(const Report& report) {
    std::vector<std::string> items;
    for (const PlannedEffect& effect : report.effects) {
        if (effect.status == EffectStatus::skipped)
            items.push_back(fmt::format("{} ({})", effect.name, moment_text(effect)));
    }
    return items.empty() ? "all run" : fmt::format("without {}", fmt::join(items, ", "));
}

/// In copy passes; never "-0.0".
std::string copies(double ms, const SkipComparison::Result& result) {
    const double tenths = std::round(10 * ms / result.copy_ms);
    return fmt::format("{:.1f}", tenths == 0 ? 0.0 : tenths / 10);
}

/// "9.1 (1.2 MiB)"; nothing where both ways are the same.
std::string saved_text(const SkipComparison::Row& row, const SkipComparison::Result& result) {
    if (row.same) return "";
    return fmt::format("{} ({} MiB)", copies(row.saved_ms, result), mebibytes_text(row.saved_bytes()));
}

std::string summary_cell(const SkipComparison::Row& row, const SkipComparison::Result& result) {
    if (row.report.effects.size() != 1)
        return fmt::format("{} of {} run; {}", row.report.effects.size() - row.skipped(),
                           row.report.effects.size(), row.same ? "0" : copies(row.saved_ms, result));
    const PlannedEffect& effect = row.report.effects.front();
    if (effect.status != EffectStatus::skipped) return "runs";
    return fmt::format("{}; {}", moment_text(effect), row.same ? "0" : copies(row.saved_ms, result));
}

std::string detail_row(const SkipComparison::Row& row, const SkipComparison::Result& result) {
    std::vector<std::string> unread;
    for (const std::string& name : row.no_skip.attachments) {
        const auto& read = row.as_is.attachments;
        if (std::find(read.begin(), read.end(), name) == read.end()) unread.push_back(name);
    }
    std::string status, moment, kind, reason;
    if (row.report.effects.size() == 1) {
        const PlannedEffect& effect = row.report.effects.front();
        const bool skipped = effect.status == EffectStatus::skipped;
        status = status_name(effect.status);
        moment = moment_text(effect);
        kind = kind_text(effect);
        if (skipped || effect.decision >= 0) reason = effect.reason;
    } else if (!row.report.effects.empty()) {
        status =
            fmt::format("{} of {}", row.report.effects.size() - row.skipped(), row.report.effects.size());
        reason = skipped_list(row.report);
    }
    return markdown_row({row.name, status, moment, kind, markdown_cell(reason),
                         copies(row.as_is.chain_ms, result),
                         row.same ? "" : copies(row.no_skip.chain_ms, result), saved_text(row, result),
                         fmt::format("{}", fmt::join(unread, ", "))});
}

std::string scene_section(const SceneFindings& scene) {
    std::string text = fmt::format("\n## {}\n\n*{}.* {} The scene itself costs {} copies.\n\n", scene.name,
                                   scene.description, bounds_text(scene.bounds),
                                   copies(scene.result.scene_ms, scene.result));
    text += "| | | Moment | Kind | Why | Cost | With everything run | Saved | Not read |\n"
            "|---|---|---|---|---|--:|--:|--:|---|\n";
    for (const SkipComparison::Row& row : scene.result.rows)
        text += detail_row(row, scene.result);
    return text;
}

nlohmann::ordered_json scene_json(const SceneFindings& scene) {
    const auto finite = [](double value) {
        return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json = {{"name", scene.name},
                                   {"nearest", finite(scene.bounds.nearest)},
                                   {"farthest", finite(scene.bounds.farthest)},
                                   {"empty", scene.bounds.empty},
                                   {"copy_ms", scene.result.copy_ms},
                                   {"scene_ms", scene.result.scene_ms},
                                   {"rows", nlohmann::ordered_json::array()}};
    for (const SkipComparison::Row& row : scene.result.rows) {
        nlohmann::ordered_json item = skip_json(row, scene.result.copy_ms);
        item["effects"] = nlohmann::ordered_json::parse(report_json(row.report))["effects"];
        json["rows"].push_back(std::move(item));
    }
    return json;
}

class SkipsCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("SCENE", scenes_,
                       "Names from configs/scenes/, scene files or models (default: all of "
                       "configs/scenes/)")
            ->default_str("");
        app.add_option("--chain", chain_, "Measured as a whole, besides every effect alone with its defaults")
            ->type_name("CHAIN")
            ->capture_default_str();
        app.add_option("--size", size_, "Of the picture, pixels")->type_name("WxH")->capture_default_str();
        app.add_option("--time", time_, "Seconds after the scenes' start")
            ->check(finite())
            ->capture_default_str();
        app.add_option("--samples", samples_, "Rounds; each draws everything of a scene once")
            ->check(CLI::Range(3, 100000))
            ->capture_default_str();
        app.add_option("-o,--output", output_, "Write the page here instead of to the terminal")
            ->type_name("FILE");
        app.add_flag("--json", json_, "As JSON");
        catalog_options_.declare(app);
    }

    Status run() override {
        const Size size = parse_size(size_);
        const Catalog catalog = catalog_options_.load();
        const Chain chain = read_chain_named(chain_, catalog);
        std::vector<Scene> scenes = open_scenes();
        const GlSession session;
        std::vector<SceneFindings> findings;
        {
            ProgressBar progress("measuring", static_cast<int>(scenes.size()) * (samples_ + warm_up_rounds));
            for (Scene& scene : scenes)
                findings.push_back(study(scene, size, catalog, chain, progress));
        }
        const std::string text = json_ ? json_of(findings, session.device().renderer)
                                       : page_of(findings, session.device().renderer);
        if (output_.empty()) {
            fmt::print("{}", text);
        } else {
            write_file_atomically(output_, text);
            fmt::print("wrote {}\n", output_);
        }
        return Status::success;
    }

private:
    std::vector<Scene> open_scenes() const {
        const std::filesystem::path directory = data_directory() / "configs/scenes";
        std::vector<std::string> names = scenes_;
        if (names.empty()) {
            for (const SceneEntry& entry : list_scenes(directory))
                names.push_back(entry.name);
        }
        std::vector<Scene> scenes;
        for (const std::string& name : names)
            scenes.push_back(open_known_scene(name));
        return scenes;
    }

    SceneFindings study(const Scene& scene, Size size, const Catalog& catalog, const Chain& chain,
                        ProgressBar& progress) const {
        ViewBounds bounds(scene);
        const SceneFacts facts = facts_of(scene, bounds, size, time_);
        SkipComparison study(scene, facts, {.fold = true}, time_);
        study.add("no effect", {});
        for (const EffectPtr& effect : catalog.effects()) {
            Chain alone;
            alone.skip = chain.skip;
            alone.add(catalog, effect->id);
            study.add(effect->id, std::move(alone));
        }
        study.add("chain " + chain_, chain);
        study.measure(samples_, progress);
        return {scene.name, scene.description, facts.bounds, study.result()};
    }

    /// What was typed, but for where the page went.
    std::string command() const {
        std::string text = "postfx skips";
        for (const std::string& scene : scenes_)
            text += " " + scene;
        return text
               + fmt::format(" --chain {} --size {} --time {} --samples {}", chain_, size_, time_, samples_);
    }

    std::string json_of(const std::vector<SceneFindings>& findings, const std::string& device) const {
        nlohmann::ordered_json json = {{"command", command()},
                                       {"device", device},
                                       {"clock", findings.front().result.clock},
                                       {"size", size_},
                                       {"scenes", nlohmann::ordered_json::array()}};
        for (const SceneFindings& scene : findings)
            json["scenes"].push_back(scene_json(scene));
        return json.dump(2) + "\n";
    }

    std::string page_of(const std::vector<SceneFindings>& findings, const std::string& device) const {
        std::string text =
            fmt::format("<!-- Made by `{0}`. Not edited by hand. -->\n\n# Called for?\n\n"
                        "Every effect alone with its defaults, and the chain `{1}`, on every scene: did it "
                        "run, and if not, who "
                        "said so and why, and what did that save against `--no-skip`.\n\n"
                        "Made by `{0} -o docs/called-for.md` on {2}. Clock: {3}. Medians of {4} rounds in "
                        "which everything was "
                        "drawn in turns, at {5}, told in copies: the time of a pass that copies the picture. "
                        "What is saved is "
                        "time of passes and of attachments that were not rendered; a number below 0 is what "
                        "asking the frame "
                        "cost. Kinds: exact changes no bit, code at most one 8-bit code, visible only what "
                        "by convention is not "
                        "seen.\n\n",
                        command(), chain_, device, findings.front().result.clock, samples_, size_);
        std::vector<std::string> head = {""}, line = {"---"};
        for (const SkipComparison::Row& row : findings.front().result.rows) {
            if (row.report.effects.empty()) continue;
            head.push_back(row.name);
            line.emplace_back("---");
        }
        text += "Where an effect was skipped: the moment, and the copies saved.\n\n" + markdown_row(head)
                + markdown_row(line);
        for (const SceneFindings& scene : findings) {
            std::vector<std::string> cells = {fmt::format("[{0}](#{0})", scene.name)};
            for (const SkipComparison::Row& row : scene.result.rows) {
                if (!row.report.effects.empty()) cells.push_back(summary_cell(row, scene.result));
            }
            text += markdown_row(cells);
        }
        for (const SceneFindings& scene : findings)
            text += scene_section(scene);
        return text;
    }

    CatalogOptions catalog_options_;
    std::vector<std::string> scenes_;
    std::string chain_ = "default", size_ = "640x360", output_;
    double time_ = 0;
    int samples_ = 11;
    bool json_ = false;
};

const Register<SkipsCommand>
    registered("skips", "Tell which effects each scene calls for, and what skipping saves", "called-for");

} // namespace
} // namespace postfx::host
