// A plan's part of a report.
#include <postfx/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

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

/// What a frame may skip, before it is known.
std::string decision_text(const Plan& plan, const PlannedEffect& effect) {
    if (effect.decision < 0) return "";
    const Decision& decision = plan.decisions[effect.decision];
    return fmt::format("; the frame skips it where {} <= {} ({})", decision.compared, decision.limit,
                       skip_kind_word(decision.kind));
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

} // namespace

Report describe(const Plan& plan) {
    Report report;
    report.effects = plan.effects;
    for (PlannedEffect& effect : report.effects)
        effect.reason += decision_text(plan, effect);
    report.clock = "none: nothing was drawn";
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

} // namespace postfx
