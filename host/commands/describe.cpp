// postfx describe: one effect's declaration.
#include "command.hpp"
#include "effect_text.hpp"
#include "options.hpp"
#include "text_table.hpp"

#include <fmt/format.h>

namespace postfx::host {
namespace {

std::string levels_text(const EffectInfo& effect) {
    if (effect.levels.empty()) return "one quality only\n";
    std::vector<std::vector<std::string>> rows;
    for (const LevelInfo& level : effect.levels) {
        const bool is_default = &level == &effect.levels.at(effect.default_level);
        rows.push_back({level.id, level.help + (is_default ? " (default)" : "")});
    }
    return "\n" + text_table(rows, 2);
}

/// "height, compiled in, does nothing at 0"
std::string remarks(const ParameterInfo& parameter) {
    std::vector<std::string> parts;
    if (parameter.identity) parts.push_back("no effect at " + identity_text(parameter));
    if (parameter.constant) parts.push_back("compiled in");
    if (parameter.logarithmic) parts.push_back("logarithmic");
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string parameters_text(const EffectInfo& effect) {
    if (effect.parameters.empty()) return "  none\n";
    std::vector<std::vector<std::string>> rows = {{"", "TYPE", "DEFAULT", "RANGE", "UNIT", ""}};
    for (const ParameterInfo& parameter : effect.parameters) {
        rows.push_back({parameter.id, std::string(parameter.kind_name()),
                        value_text(parameter, parameter.default_value), range_text(parameter), parameter.unit,
                        remarks(parameter)});
    }
    // The table is made whole, so that columns agree; each parameter's help then goes below its row.
    const std::string table = text_table(rows, 2);
    std::string text = table.substr(0, table.find('\n') + 1);
    std::size_t at = text.size();
    for (const ParameterInfo& parameter : effect.parameters) {
        const std::size_t end = table.find('\n', at) + 1;
        text += table.substr(at, end - at) + wrapped(parameter.help, 6);
        at = end;
    }
    return text;
}

std::string effect_text(const EffectInfo& effect) {
    return fmt::format("{} {}\n{}\n", effect.id, effect.version, effect.help)
           + fmt::format("Stage: {}\nReads: {}\nFrom: {}\nQuality: {}", stage_text(effect),
                         reads_text(effect), effect.module_path.string(), levels_text(effect))
           + "Parameters:\n" + parameters_text(effect);
}

class DescribeCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("EFFECT", effect_, "The effect's id, as `postfx list effects` tells it")->required();
        app.add_flag("--json", json_,
                     "As JSON: {id, version, help, stage, parameters: [{id, type, default, min, max, step, "
                     "unit, identity, help, choices, constant}], reads, levels, default_level, module}");
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
