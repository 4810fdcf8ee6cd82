// postfx docs: the reference pages, made from what the code itself declares.
#include "command.hpp"
#include "options.hpp"

#include "run/resources.hpp"
#include "terminal/effect_text.hpp"
#include "terminal/text_table.hpp"

#include <image/files.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <fstream>
#include <map>

namespace fs = std::filesystem;

namespace postfx::host {
namespace {

/// First line of every page; a page that starts with it may be overwritten and removed.
constexpr std::string_view generated =
    "<!-- Made by `./run docs --out docs/reference` from the code. Not edited by hand. -->\n";

std::string code_or_empty(const std::string& text) {
    return text.empty() ? "" : "`" + text + "`";
}

std::string parameters_page(const EffectInfo& effect) {
    if (effect.parameters.empty()) return "It has no parameters.\n";
    std::string text =
        "| Parameter | Type | Default | Range | Unit | No effect at | |\n|---|---|---|---|---|---|---|\n";
    for (const ParameterInfo& parameter : effect.parameters) {
        text += fmt::format("| `{}` | {} | `{}` | {} | {} | {} | {}{} |\n", parameter.id,
                            parameter.kind_name(), value_text(parameter, parameter.default_value),
                            markdown_cell(range_text(parameter)), markdown_cell(parameter.unit),
                            code_or_empty(identity_text(parameter)), markdown_cell(parameter.help),
                            parameter.constant ? ". Compiled into the shader" : "");
    }
    return text;
}

std::string levels_page(const EffectInfo& effect) {
    if (effect.levels.empty()) return "";
    std::string text = "\n## Quality levels\n\n| `quality` | |\n|---|---|\n";
    for (const LevelInfo& level : effect.levels) {
        const bool is_default = &level == &effect.levels.at(effect.default_level);
        text += fmt::format("| `{}`{} | {} |\n", level.id, is_default ? " (default)" : "",
                            markdown_cell(level.help));
    }
    return text;
}

/// A chain entry that sets everything to its default.
std::string example(const EffectInfo& effect) {
    std::string text = "\n## In a chain\n\n```yaml\neffects:\n  - " + effect.id;
    if (effect.parameters.empty() && effect.levels.empty()) return text + "\n```\n";
    text += ":\n";
    if (!effect.levels.empty())
        text += fmt::format("      quality: {}\n", effect.levels.at(effect.default_level).id);
    for (const ParameterInfo& parameter : effect.parameters)
        text += fmt::format("      {}: {}\n", parameter.id, value_text(parameter, parameter.default_value));
    return text + "```\n";
}

std::string effect_page(const EffectInfo& effect) {
    std::string text{generated};
    text +=
        fmt::format("\n# {}\n\n{}.\n\n| | |\n|---|---|\n| Stage | {} |\n| Reads | {} |\n| Version | {} |\n",
                    effect.id, effect.help, stage_text(effect), reads_text(effect), effect.version);
    const std::string readme = fmt::format("plugins/{}/README.md", effect.id);
    if (fs::exists(data_directory() / readme))
        text += fmt::format("| Model, tests | [{0}](../../../{0}) |\n", readme);
    return text + "\n## Parameters\n\n" + parameters_page(effect) + levels_page(effect) + example(effect);
}

std::string index_page(const Catalog& catalog) {
    std::string text{generated};
    text += "\n# Reference\n\n- [The program](cli.md): every command and option\n\n"
            "## Effects\n\n| Effect | Stage | |\n|---|---|---|\n";
    for (const EffectPtr& effect : catalog.effects()) {
        text += fmt::format("| [{0}](effects/{0}.md) | {1} | {2} |\n", effect->id, stage_word(effect->stage),
                            markdown_cell(effect->help));
    }
    return text;
}

/// The help that `--help` prints. App::help() would give that of the running subcommand instead.
std::string help_of(const CLI::App& app, const std::string& name) {
    return "```text\n" + app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal) + "```\n";
}

std::string cli_page(const CLI::App& program) {
    std::string text =
        fmt::format("{}\n# The program\n\n{}", generated, help_of(program, program.get_name()));
    for (const CLI::App* command : program.get_subcommands({})) {
        if (command->get_group().empty()) continue; // hidden
        const std::string name = program.get_name() + " " + command->get_name();
        text += fmt::format("\n## {}\n\n{}", name, help_of(*command, name));
    }
    return text;
}

/// Generated pages in `folder` that are not among `pages`: effects that are gone.
std::vector<fs::path> stale_pages(const fs::path& folder, const std::map<std::string, std::string>& pages) {
    std::vector<fs::path> stale;
    if (!fs::is_directory(folder / "effects")) return stale;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "effects")) {
        std::ifstream in(entry.path());
        std::string first;
        const bool ours = std::getline(in, first) && first + "\n" == generated;
        if (ours && !pages.contains("effects/" + entry.path().filename().string()))
            stale.push_back(entry.path());
    }
    return stale;
}

class DocsCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app_ = &app;
        app.add_option("--out", folder_, "Folder of the pages, docs/reference in the sources")
            ->required()
            ->type_name("DIR");
        catalog_.declare(app);
        app.footer(
            "For maintainers: README.md, cli.md and effects/*.md, from the effects found. Pages that it "
            "made\n"
            "for effects that are gone are removed. A test fails when docs/reference is not up to date.");
    }

    Status run() override {
        const Catalog catalog = catalog_.load();
        std::map<std::string, std::string> pages;
        pages["README.md"] = index_page(catalog);
        pages["cli.md"] = cli_page(*app_->get_parent());
        for (const EffectPtr& effect : catalog.effects())
            pages["effects/" + effect->id + ".md"] = effect_page(*effect);
        write(pages);
        fmt::print("{} pages are in {}\n", pages.size(), folder_);
        return Status::success;
    }

private:
    void write(const std::map<std::string, std::string>& pages) const {
        try {
            fs::create_directories(fs::path(folder_) / "effects");
            for (const fs::path& page : stale_pages(folder_, pages))
                fs::remove(page);
        } catch (const fs::filesystem_error& error) {
            throw Error(Place{.file = folder_}, "can't be written: " + error.code().message());
        }
        for (const auto& [name, text] : pages)
            write_file_atomically(fs::path(folder_) / name, text);
    }

    CatalogOptions catalog_;
    const CLI::App* app_ = nullptr;
    std::string folder_;
};

const Register<DocsCommand> registered("docs", "Write the reference pages from the code (for maintainers)");

} // namespace
} // namespace postfx::host
