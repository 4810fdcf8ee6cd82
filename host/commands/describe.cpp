// postfx describe: one effect's declaration.
#include "command.hpp"
#include "options.hpp"

#include "terminal/effect_text.hpp"
#include "terminal/text_table.hpp"

#include <fmt/format.h>

namespace postfx::host {
namespace {

/// Rows of a table: "quality  low   fast enough for ..."
std::vector<std::vector<std::string>> facts(const EffectInfo& effect) {
    std::vector<std::vector<std::string>> rows = {{"stage", stage_text(effect)},
                                                  {"reads", reads_text(effect)},
                                                  {"module", effect.module_path.string()}};
    for (const LevelInfo& level : effect.levels) {
        const bool is_default = &level == &effect.levels.at(effect.default_level);
        const char* heading = &level == &effect.levels.front() ? "quality" : "";
        rows.push_back(
            {heading, fmt::format("{}{}: {}", level.id, is_default ? " (default)" : "", level.help)});
    }
    return rows;
}

/// "no effect at 0, compiled in"
std::string remarks(const ParameterInfo& parameter) {
    std::vector<std::string> parts;
    if (parameter.identity) parts.emplace_back("no effect at " + identity_text(parameter));
    if (parameter.constant) parts.emplace_back("compiled in");
    if (parameter.logarithmic) parts.emplace_back("logarithmic");
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string parameters_text(const EffectInfo& effect) {
    if (effect.parameters.empty()) return "no parameters\n";
    std::vector<std::vector<std::string>> rows = {{"PARAMETER", "TYPE", "DEFAULT", "RANGE", "UNIT", ""}};
    for (const ParameterInfo& parameter : effect.parameters) {
        rows.push_back({parameter.id, std::string(parameter.kind_name()),
                        value_text(parameter, parameter.default_value), range_text(parameter), parameter.unit,
                        remarks(parameter)});
    }
    // The table is made whole, so that columns agree; each parameter's help then goes below its row.
    const std::string table = text_table(rows, 0);
    std::string text = table.substr(0, table.find('\n') + 1);
    std::size_t at = text.size();
    for (const ParameterInfo& parameter : effect.parameters) {
        const std::size_t end = table.find('\n', at) + 1;
        text += table.substr(at, end - at) + wrapped(parameter.help, 4);
        at = end;
    }
    return text;
}

std::string effect_text(const EffectInfo& effect) {
    return fmt::format("{} {}: {}\n\n{}\n{}", effect.id, effect.version, effect.help,
                       text_table(facts(effect), 2), parameters_text(effect));
}

class DescribeCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("EFFECT", effect_, "The effect's id, as `postfx list effects` tells it")
            ->required()
            ->type_name("");
        app.add_flag("--json", json_, "As JSON");
        app.footer("JSON: {id, version, help, stage, parameters: [{id, type, default, min, max, step, unit, "
                   "identity,\n"
                   "help, choices, constant}], reads, levels: [{id, help}], default_level, module}. What "
                   "there is not\n"
                   "is null: an identity, a range of words (choice) or booleans, a default_level.");
        catalog_.declare(app);
    }

    Status run() override {
        const Catalog catalog = catalog_.load();
        const EffectInfo& effect = find_effect(catalog, effect_);
        fmt::print("{}", json_ ? effect_json(effect).dump(2) + "\n" : effect_text(effect));
        return Status::success;
    }

private:
    CatalogOptions catalog_;
    std::string effect_;
    bool json_ = false;
};

const Register<DescribeCommand> registered("describe",
                                           "Tell an effect's parameters, inputs and quality levels");

} // namespace
} // namespace postfx::host
