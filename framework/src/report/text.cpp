// Reports and plans for people.
#include <postfx/report.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace postfx {
namespace {

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
    if (programs.warmed > 0) text += fmt::format("; a second thread went through {} of all", programs.warmed);
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

std::string plan_text(const Plan& plan, const std::string& clock) {
    Report report = describe(plan);
    report.clock = clock;
    return fmt::format("{}attachments rendered: {}\n", report_text(report),
                       fmt::join(plan.attachments, ", "));
}

} // namespace postfx
