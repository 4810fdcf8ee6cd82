#include "sentences.hpp"

#include "pareto.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace postfx::host::study {
namespace {

/// A truth's own error that is no more than float64 leaves.
constexpr double rounding = 1e-9;

/// Two digits, more only before the point.
std::string short_number(double value) {
    const double size = std::abs(value);
    if (size >= 9.95) return fmt::format("{:.0f}", value);
    if (size >= 0.995) return fmt::format("{:.1f}", value);
    return fmt::format("{:.2g}", value);
}

bool is_classic(const Level& level) {
    return level.id == classic_level;
}

std::string closer_text(const Level& better, const Level& level) {
    if (*better.error == 0) return "exact where " + level.name() + " is not";
    return fmt::format("{} closer to the truth than {}", times_text(*level.error / *better.error),
                       level.name());
}

/// How the time of one compares with another's, to stand behind "for".
std::string price_text(const Level& level, const Level& than) {
    if (!(than.ms.median > 0) || !(level.ms.median > 0)) return "a time too short to compare";
    const double ratio = level.ms.median / than.ms.median;
    if (ratio > 0.95 && ratio < 1.05) return "the same time";
    return times_text(ratio) + " the time";
}

/// The curve without the way it is usually done.
std::vector<const Level*> ladder_of(const EffectFindings& effect) {
    std::vector<const Level*> ladder;
    for (const std::size_t i : curve_of(effect)) {
        if (!is_classic(effect.levels[i])) ladder.push_back(&effect.levels[i]);
    }
    return ladder;
}

std::string ladder_sentence(const EffectFindings& effect, const std::vector<const Level*>& ladder) {
    const Level& first = *ladder.front();
    std::string text =
        fmt::format("{}: {} is {} from the truth and takes {}", effect.id, first.name(),
                    *first.error == 0 ? "not at all away" : percent_text(*first.error) + " away",
                    duration_text(first.ms.median));
    for (std::size_t i = 1; i < ladder.size(); ++i) {
        text += fmt::format("; {} is {} for {}", ladder[i]->name(), closer_text(*ladder[i], *ladder[i - 1]),
                            price_text(*ladder[i], *ladder[i - 1]));
    }
    return text + ".";
}

/// Of those that take no longer than classic, the closest; else the quickest that is closer.
const Level* rival_of(const Level& classic, const std::vector<const Level*>& ladder) {
    const Level* rival = nullptr;
    for (const Level* level : ladder) {
        if (level->ms.median <= classic.ms.median * 1.05) rival = level;
    }
    if (rival) return rival;
    for (const Level* level : ladder) {
        if (*level->error < *classic.error) return level;
    }
    return nullptr;
}

std::string classic_sentence(const Level& classic, const std::vector<const Level*>& ladder) {
    const std::string start = "The way it is usually done (classic) ";
    const Level* rival = rival_of(classic, ladder);
    if (!rival)
        return start
               + fmt::format("is {} from the truth and takes {}; no level is closer.",
                             percent_text(*classic.error), duration_text(classic.ms.median));
    if (*rival->error >= *classic.error)
        return start
               + fmt::format("is {} closer to the truth than {} for {}.",
                             times_text(*rival->error / *classic.error), rival->name(),
                             price_text(classic, *rival));
    const std::string farther = *rival->error == 0
                                    ? fmt::format("is {} from the truth, where {} is exact",
                                                  percent_text(*classic.error), rival->name())
                                    : fmt::format("is {} farther from the truth than {}",
                                                  times_text(*classic.error / *rival->error), rival->name());
    return start + farther + fmt::format(" for {}.", price_text(classic, *rival));
}

std::string dominated_sentence(const EffectFindings& effect, const Level& level) {
    const Level* better = effect.find(level.dominated_by);
    const bool closer = *better->error < 0.98 * *level.error,
               faster = better->ms.median < 0.98 * level.ms.median;
    const std::string speed = better->ms.median > 0 && level.ms.median > 0
                                  ? times_text(level.ms.median / better->ms.median) + " faster"
                                  : std::string("faster");
    return fmt::format("{} is not worth its time: {} is {}{}.", level.name(), better->name(),
                       closer ? closer_text(*better, level) : "as close",
                       faster ? " and " + speed : " and no slower");
}

std::string limit_sentence(const EffectFindings& effect, const std::vector<const Level*>& ladder) {
    const Level& best = *ladder.back();
    const double own = effect.own_error();
    std::string text =
        fmt::format("At best, {} is {} from the truth", best.name(),
                    *best.error == 0 ? "not at all away" : percent_text(*best.error) + " away");
    const auto inputs = effect.inputs_error();
    if (effect.judged_by == "scene" && inputs && *inputs > 0) {
        text += fmt::format("; the best that can be made of what the effect is given is itself {} away",
                            percent_text(*inputs));
    }
    if (own > rounding) text += fmt::format("; the truth itself is known to {}", percent_text(own));
    return text + (own > rounding || effect.judged_by.empty() ? "." : "; the truth is exact up to rounding.");
}

std::string growth_sentence(const Growth& growth) {
    std::vector<std::string> parts;
    for (const GrowthCurve& curve : growth.curves) {
        if (curve.time_exponent)
            parts.push_back(fmt::format("{} {:.2f}", curve.level.empty() ? "its only level" : curve.level,
                                        *curve.time_exponent));
    }
    if (parts.empty()) return "";
    return fmt::format("Time grows with the {} to the power of: {}.",
                       growth.over == "radius" ? "radius" : "number of pixels", fmt::join(parts, ", "));
}

} // namespace

std::string times_text(double ratio) {
    return short_number(ratio) + "x";
}

std::string percent_text(double share) {
    if (share == 0) return "0 %";
    if (!std::isfinite(share)) return "infinitely far";
    return short_number(100 * share) + " %";
}

std::string duration_text(double ms) {
    if (!(ms > 0)) return "no time that can be measured";
    return ms >= 1000 ? short_number(ms / 1000) + " s" : short_number(ms) + " ms";
}

std::vector<std::string> sentences_of(const EffectFindings& effect) {
    std::vector<std::string> sentences;
    const std::vector<const Level*> ladder = ladder_of(effect);
    if (ladder.empty()) {
        std::vector<std::string> parts;
        for (const Level& level : effect.levels)
            parts.push_back(fmt::format("{} takes {}", level.name(), duration_text(level.ms.median)));
        sentences.push_back(fmt::format("{}: {}. How close it is to the truth is not known.", effect.id,
                                        fmt::join(parts, ", ")));
    } else {
        sentences.push_back(ladder_sentence(effect, ladder));
        const Level* classic = effect.find(classic_level);
        if (classic && classic->error) sentences.push_back(classic_sentence(*classic, ladder));
        for (const Level& level : effect.levels) {
            if (!level.dominated_by.empty() && !is_classic(level))
                sentences.push_back(dominated_sentence(effect, level));
        }
        sentences.push_back(limit_sentence(effect, ladder));
    }
    for (const Growth& growth : effect.growth) {
        if (const std::string text = growth_sentence(growth); !text.empty()) sentences.push_back(text);
    }
    return sentences;
}

} // namespace postfx::host::study
