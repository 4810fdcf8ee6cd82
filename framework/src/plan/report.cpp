#include <postfx/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace postfx {
namespace {

/// Where an input comes from, for people: the attachment, or the last pass before `reader` that wrote the
/// target.
std::string source_name(const Plan& plan, std::size_t reader, const ImageRef& image) {
    if (image.kind == ImageRef::Kind::attachment) return plan.attachments[image.index];
    for (std::size_t i = reader; i-- > 0;) {
        const auto& outputs = plan.passes[i].outputs;
        const auto at = std::find(outputs.begin(), outputs.end(), image);
        if (at == outputs.end()) continue;
        const auto output = at - outputs.begin();
        return plan.passes[i].name + (output > 0 ? fmt::format(".{}", output) : "");
    }
    return "?";
}

template<class Value>
nlohmann::ordered_json optional_json(const std::optional<Value>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// "if glow, not shade"; alternatives with "or".
std::string condition_text(const Plan& plan, const Condition& condition) {
    std::vector<std::string> terms;
    for (const Term& term : condition) {
        std::vector<std::string> words;
        for (const PlannedEffect& effect : plan.effects) {
            if (effect.decision < 0) continue;
            if (term.live >> effect.decision & 1u) words.push_back(effect.name);
            if (term.dead >> effect.decision & 1u) words.push_back("not " + effect.name);
        }
        terms.push_back(fmt::format("{}", fmt::join(words, ", ")));
    }
    return terms.empty() ? "" : fmt::format("if {}", fmt::join(terms, " or "));
}

/// "" of an effect that is not skipped, as the kind is.
std::string_view moment_text(const PlannedEffect& effect) {
    return effect.moment ? moment_word(*effect.moment) : "";
}

std::string_view kind_text(const PlannedEffect& effect) {
    return effect.kind ? skip_kind_word(*effect.kind) : "";
}

/// What a frame may skip, before it is known.
std::string decision_text(const Plan& plan, const PlannedEffect& effect) {
    if (effect.decision < 0) return "";
    const Decision& decision = plan.decisions[effect.decision];
    return fmt::format("; the frame skips it where {} <= {} ({})", decision.compared, decision.limit,
                       skip_kind_word(decision.kind));
}

std::string time_text(const PassReport& pass) {
    std::string text;
    if (pass.cpu_ms) text += fmt::format("  {:8.2f} ms cpu", *pass.cpu_ms);
    if (pass.wall_ms) text += fmt::format("  {:8.2f} ms wall", *pass.wall_ms);
    if (pass.gpu_ms) text += fmt::format("  {:8.3f} ms gpu", *pass.gpu_ms);
    return text;
}

std::string reads_text(const PassReport& pass) {
    return pass.reads.empty() ? "" : fmt::format("  reads {}", fmt::join(pass.reads, ", "));
}

/// A pixel format, or what else comes out of a pass.
std::string what_it_makes(const Pass& pass) {
    switch (pass.kind) {
    case PassKind::draw:
        return std::string(format_info(pass.format).name);
    case PassKind::census:
        return "census";
    case PassKind::decide:
        return "decision";
    }
    return "";
}

std::string census_name(const Plan& plan, int slot) {
    const auto counted = std::find_if(plan.passes.begin(), plan.passes.end(), [&](const Pass& pass) {
        return pass.kind == PassKind::census && pass.slot == slot;
    });
    return counted->name;
}

std::string tile_text(const PassReport& pass) {
    if (pass.tiles == 0) return "";
    if (!pass.tiles_drawn) return fmt::format("  in some of {} tiles", pass.tiles);
    return fmt::format("  in {} of {} tiles", *pass.tiles_drawn, pass.tiles);
}

std::string taps_text(const PassReport& pass) {
    if (!pass.taps) return "";
    return fmt::format("  {:.2f} taps per pixel",
                       static_cast<double>(*pass.taps) / (static_cast<double>(pass.width) * pass.height));
}

std::string programs_text(const ProgramCount& programs) {
    std::string text = fmt::format("programs  {}", programs.all);
    if (programs.compiled > 0) text += fmt::format(", {} never compiled before", programs.compiled);
    if (programs.warmed > 0) text += fmt::format(", {} of all on a second thread", programs.warmed);
    return text + "\n";
}

/// What an effect cost: its own passes, and those that it shares with others.
std::string cost_text(const Report& report, const PlannedEffect& effect) {
    double own = 0, shared = 0;
    bool known = false;
    for (const PassReport& pass : report.passes) {
        const std::optional<double> time = pass.cpu_ms ? pass.cpu_ms : pass.gpu_ms;
        const bool uses =
            std::find(pass.effects.begin(), pass.effects.end(), effect.name) != pass.effects.end();
        if (!uses || !time) continue;
        known = true;
        (pass.effects.size() == 1 ? own : shared) += *time;
    }
    if (!known) return "";
    std::string text = own > 0 ? fmt::format("{:.1f} ms", own) : "";
    if (shared > 0) text += fmt::format("{}{:.1f} ms shared", own > 0 ? " + " : "", shared);
    return text + "; ";
}

} // namespace

Report describe(const Plan& plan) {
    Report report;
    report.effects = plan.effects;
    for (PlannedEffect& effect : report.effects)
        effect.reason += decision_text(plan, effect);
    report.clock = "none: times were not asked for";
    report.texture_bytes = plan.texture_bytes();
    report.warnings = plan.warnings;
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const Pass& pass = plan.passes[i];
        PassReport described;
        described.name = pass.name;
        described.effects = pass.effects;
        described.width = pass.width;
        described.height = pass.height;
        described.condition = condition_text(plan, pass.condition);
        described.tiles = pass.tiles_across * pass.tiles_down;
        described.format = what_it_makes(pass);
        for (const PassInput& input : pass.inputs) {
            std::string name = source_name(plan, i, input.image);
            if (std::find(described.reads.begin(), described.reads.end(), name) == described.reads.end()) {
                described.reads.push_back(std::move(name));
            }
        }
        for (int slot : pass.censuses)
            described.reads.push_back(census_name(plan, slot));
        report.passes.push_back(std::move(described));
    }
    return report;
}

std::string report_json(const Report& report) {
    nlohmann::ordered_json json;
    json["effects"] = nlohmann::ordered_json::array();
    for (const PlannedEffect& effect : report.effects) {
        json["effects"].push_back({{"id", effect.id},
                                   {"name", effect.name},
                                   {"status", status_name(effect.status)},
                                   {"moment", moment_text(effect)},
                                   {"kind", kind_text(effect)},
                                   {"reason", effect.reason}});
    }
    json["passes"] = nlohmann::ordered_json::array();
    for (const PassReport& pass : report.passes) {
        json["passes"].push_back({{"name", pass.name},
                                  {"effects", pass.effects},
                                  {"width", pass.width},
                                  {"height", pass.height},
                                  {"format", pass.format},
                                  {"reads", pass.reads},
                                  {"condition", pass.condition},
                                  {"drawn", optional_json(pass.drawn)},
                                  {"tiles", pass.tiles},
                                  {"tiles_drawn", optional_json(pass.tiles_drawn)},
                                  {"taps", optional_json(pass.taps)},
                                  {"cpu_ms", optional_json(pass.cpu_ms)},
                                  {"wall_ms", optional_json(pass.wall_ms)},
                                  {"gpu_ms", optional_json(pass.gpu_ms)}});
    }
    json["clock"] = report.clock;
    json["texture_bytes"] = report.texture_bytes;
    json["programs"] = nullptr;
    if (report.programs) {
        json["programs"] = {{"all", report.programs->all},
                            {"compiled", report.programs->compiled},
                            {"warmed", report.programs->warmed}};
    }
    json["warnings"] = report.warnings;
    json["nonfinite"] = nullptr;
    if (report.nonfinite) {
        json["nonfinite"] = nlohmann::ordered_json::array();
        for (const NonfiniteImage& image : *report.nonfinite) {
            json["nonfinite"].push_back({{"name", image.name},
                                         {"pixels", image.pixels},
                                         {"x", image.x},
                                         {"y", image.y},
                                         {"made_here", image.made_here}});
        }
    }
    return json.dump(2);
}

std::string report_text(const Report& report) {
    std::size_t effect_width = 6, pass_width = 4;
    for (const PlannedEffect& effect : report.effects)
        effect_width = std::max(effect_width, effect.name.size());
    for (const PassReport& pass : report.passes)
        pass_width = std::max(pass_width, pass.name.size());

    std::string text = "effects\n";
    for (const PlannedEffect& effect : report.effects) {
        const std::string moment = effect.moment ? fmt::format("{}: ", moment_word(*effect.moment)) : "";
        const bool tells_kind = effect.kind && effect.kind != SkipKind::lacks;
        text += fmt::format("  {:<{}}  {:<7}  {}{}{}{}\n", effect.name, effect_width,
                            status_name(effect.status), cost_text(report, effect), moment, effect.reason,
                            tells_kind ? fmt::format(" ({})", skip_kind_word(*effect.kind)) : "");
    }
    text += "passes\n";
    for (const PassReport& pass : report.passes) {
        if (!pass.drawn.value_or(true)) continue;
        text +=
            fmt::format("  {:<{}}  {:>4}x{:<4} {:<10}{}{}{}{}{}\n", pass.name, pass_width, pass.width,
                        pass.height, pass.format, time_text(pass), taps_text(pass), reads_text(pass),
                        tile_text(pass), pass.condition.empty() || pass.drawn ? "" : "  " + pass.condition);
    }
    text += fmt::format("textures  {:.1f} MiB\nclock     {}\n",
                        static_cast<double>(report.texture_bytes) / (1024 * 1024), report.clock);
    if (report.programs) text += programs_text(*report.programs);
    for (const std::string& warning : report.warnings)
        text += fmt::format("warning   {}\n", warning);
    if (report.nonfinite && report.nonfinite->empty()) text += "non-finite  none in any image\n";
    for (const NonfiniteImage& image : report.nonfinite.value_or(std::vector<NonfiniteImage>{})) {
        text += fmt::format("non-finite  {}: {} pixels, the first at ({}, {}){}\n", image.name, image.pixels,
                            image.x, image.y, image.made_here ? "; made by this pass" : "");
    }
    return text;
}

} // namespace postfx
