#include "effect_plots.hpp"
#include "log_scale.hpp"
#include "page.hpp"
#include "pareto.hpp"
#include "plot.hpp"
#include "sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host::study {
namespace {

/// An HTML table; cells are HTML.
class Table {
public:
    explicit Table(const std::vector<std::string>& heads) {
        html_ = "<div class=\"scroll\"><table>\n<thead><tr>";
        for (const std::string& head : heads)
            html_ += "<th scope=\"col\">" + head + "</th>";
        html_ += "</tr></thead>\n<tbody>\n";
    }
    void add(const std::vector<std::string>& cells, const std::string& style = "") {
        html_ += style.empty() ? "<tr>" : "<tr class=\"" + style + "\">";
        for (std::size_t i = 0; i < cells.size(); ++i)
            html_ += i == 0 ? "<th scope=\"row\">" + cells[i] + "</th>" : "<td>" + cells[i] + "</td>";
        html_ += "</tr>\n";
    }
    std::string html() const { return html_ + "</tbody></table></div>\n"; }

private:
    std::string html_;
};

/// Three digits, all before the point.
std::string plain_text(double value) {
    if (value <= 0) return "0";
    return value < 999.5 ? fmt::format("{:.3g}", value) : tick_text(value);
}

std::string spread_text(const Spread& spread) {
    if (spread.rounds < 3)
        return fmt::format("{} <small>{}x</small>", plain_text(spread.median), spread.rounds);
    return fmt::format("{} <small>{}&#8239;&ndash;&#8239;{}</small>", plain_text(spread.median),
                       plain_text(spread.p10), plain_text(spread.p90));
}

std::string share_text(double share) {
    if (!std::isfinite(share)) return "not finite";
    return share > 0 && share < 5e-7 ? "&lt;&#8239;0.0001" : fmt::format("{:.3g}", 100 * share);
}

std::string mean_error(const Level& level, const std::string& kind, double PictureError::*value) {
    double sum = 0;
    for (const LevelOnScene& scene : level.scenes) {
        const auto found = scene.errors.find(kind);
        if (found == scene.errors.end()) return "";
        sum += found->second.*value;
    }
    return level.scenes.empty() ? "" : share_text(sum / static_cast<double>(level.scenes.size()));
}

double mean_copies(const Level& level) {
    double sum = 0;
    int count = 0;
    for (const LevelOnScene& scene : level.scenes) {
        if (scene.costs.empty()) continue;
        sum += scene.costs.front().copies.median;
        ++count;
    }
    return count == 0 ? 0 : sum / count;
}

bool has_truth(const EffectFindings& effect, const std::string& kind) {
    return std::any_of(effect.levels.begin(), effect.levels.end(), [&](const Level& level) {
        return !mean_error(level, kind, &PictureError::relative_rmse).empty();
    });
}

std::string row_style(const Level& level) {
    std::string style = level.id == classic_level ? "classic" : "";
    if (!level.dominated_by.empty()) style += style.empty() ? "dominated" : " dominated";
    return style;
}

std::string metric_text(double value) {
    return std::isnan(value) ? "&ndash;" : fmt::format("{:.3g}", value);
}

/// Hundredths count: a pass of 1/64 of the pixels may read one each.
std::string taps_text(const std::optional<double>& taps) {
    return taps ? fmt::format("{:.{}f}", *taps, *taps < 99.995 ? 2 : 0) : "&ndash;";
}

/// Means over scenes.
std::string level_table(const EffectFindings& effect) {
    const bool scene = has_truth(effect, "scene"), layer = has_truth(effect, "layer");
    std::vector<std::string> heads = {"Level", "Time, ms", "Copies"};
    if (scene) heads.insert(heads.end(), {"Error, scene, %", "FLIP, scene, %"});
    if (layer) heads.insert(heads.end(), {"Error, layer, %", "FLIP, layer, %"});
    for (const MetricFacts& metric : effect.metrics) {
        const std::string unit = metric.unit.empty() ? "" : ", " + metric.unit;
        heads.push_back(fmt::format("<abbr title=\"{}\">{}{}</abbr>", escaped(metric.help),
                                    escaped(metric.name), escaped(unit)));
    }
    heads.insert(heads.end(), {"Step up, FLIP %", "Passes", "Taps", "Bytes written / read"});
    Table table(heads);
    for (const Level& level : effect.levels) {
        std::string name = fmt::format("<b>{}</b>", escaped(level.name()));
        if (!level.dominated_by.empty())
            name += fmt::format(" <small>dominated by {}</small>", escaped(level.dominated_by));
        if (!level.help.empty()) name += fmt::format("<span class=\"help\">{}</span>", escaped(level.help));
        std::vector<std::string> cells = {name, spread_text(level.ms), plain_text(mean_copies(level))};
        for (const char* kind : {"scene", "layer"}) {
            if (kind == std::string("scene") ? !scene : !layer) continue;
            cells.push_back(mean_error(level, kind, &PictureError::relative_rmse));
            cells.push_back(mean_error(level, kind, &PictureError::flip));
        }
        for (const double value : level.metrics)
            cells.push_back(metric_text(value));
        cells.push_back(level.step_to_next > 0 ? share_text(level.step_to_next) : "");
        cells.push_back(fmt::format("{}", level.passes));
        cells.push_back(taps_text(level.taps));
        cells.push_back(fmt::format("{:.3g} / {:.3g}", level.bytes_written, level.bytes_read));
        table.add(cells, row_style(level));
    }
    return table.html();
}

std::string figures(const std::vector<EffectPlot>& plots, const char* style) {
    if (plots.empty()) return "";
    std::string html = fmt::format("<div class=\"plots {}\">\n", style);
    for (const EffectPlot& plot : plots)
        html +=
            fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", plot.svg, escaped(plot.caption));
    return html + "</div>\n";
}

std::string thumbnail_caption(const std::string& name) {
    if (name == "given") return "what the effect is given";
    if (name == "truth") return "the truth";
    return name.empty() ? "its only level" : name;
}

std::string thumbnails(const EffectFindings& effect, const std::map<std::string, std::string>& pictures) {
    std::string html = "<div class=\"thumbnails\">\n";
    for (const Thumbnail& thumbnail : effect.thumbnails) {
        const auto found = pictures.find(effect.id + "-" + thumbnail.name);
        if (found == pictures.end()) continue;
        const std::string caption = thumbnail_caption(thumbnail.name);
        html += fmt::format("<figure><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" "
                            "src=\"data:image/png;base64,{3}\"><figcaption>{0}</figcaption></figure>\n",
                            escaped(caption), thumbnail.width, thumbnail.height, base64(found->second));
    }
    html += "</div>\n";
    const std::string scene = effect.scenes.empty() ? "" : effect.scenes.front().name;
    const std::string what =
        effect.heat_white > 0 ? fmt::format(
            "{}: where each level is seen to differ from the truth; black is no difference, white a FLIP "
            "of {} or more.",
            scene, percent_text(effect.heat_white))
                              : fmt::format("{}: pictures of the levels.", scene);
    return html + "<p class=\"note\">" + escaped(what) + "</p>\n";
}

/// Scene by scene: truths, then what each level does there.
std::string scene_details(const EffectFindings& effect) {
    std::string html = "<details><summary>Scene by scene</summary>\n";
    for (std::size_t s = 0; s < effect.scenes.size(); ++s) {
        const SceneFindings& scene = effect.scenes[s];
        html += fmt::format("<h4>{} <small>{}</small></h4>\n<ul class=\"truths\">\n", escaped(scene.name),
                            escaped(scene.description));
        for (const TruthFacts& truth : scene.truths) {
            const std::string own = truth.statistics         ? "compared by statistics only"
                                    : truth.own_error < 1e-9 ? "exact up to rounding"
                                                             : "own error " + percent_text(truth.own_error);
            html += fmt::format("<li><b>{}</b>: {}; {}</li>\n", escaped(truth.kind),
                                escaped(truth.description), own);
        }
        for (const auto& [kind, why] : scene.no_truth)
            html += fmt::format("<li><b>{}</b>: none, {}</li>\n", escaped(kind), escaped(why));
        html += "</ul>\n";
        std::vector<std::string> heads = {"Level", "Error, scene, %", "FLIP, %", "Error, layer, %",
                                          "FLIP, %"};
        const std::vector<Cost>& sizes = effect.levels.front().scenes[s].costs;
        for (const Cost& cost : sizes)
            heads.push_back(fmt::format("ms at {}x{}", cost.width, cost.height));
        heads.insert(heads.end(), {"Rounds", "Taps", ""});
        Table table(heads);
        for (const Level& level : effect.levels) {
            const LevelOnScene& here = level.scenes[s];
            std::vector<std::string> cells = {escaped(level.name())};
            for (const char* kind : {"scene", "layer"}) {
                const auto found = here.errors.find(kind);
                const bool known = found != here.errors.end();
                cells.push_back(known ? share_text(found->second.relative_rmse) : "");
                cells.push_back(known ? share_text(found->second.flip) : "");
            }
            std::string rounds;
            for (const Cost& cost : here.costs) {
                cells.push_back(spread_text(cost.ms));
                rounds += fmt::format("{}{}", rounds.empty() ? "" : ", ", cost.ms.rounds);
            }
            cells.push_back(rounds);
            cells.push_back(taps_text(here.taps));
            cells.push_back(here.skipped.empty() ? "" : "did not run: " + escaped(here.skipped));
            table.add(cells, row_style(level));
        }
        html += table.html();
    }
    return html + "</details>\n";
}

std::string metric_details(const EffectFindings& effect) {
    if (effect.metrics.empty()) return "";
    std::string html =
        "<details><summary>Its own measurements, on inputs with a known answer</summary>\n<dl>\n";
    for (const MetricFacts& metric : effect.metrics)
        html += fmt::format("<dt>{}{}</dt><dd>{}</dd>\n", escaped(metric.name),
                            metric.unit.empty() ? "" : ", " + escaped(metric.unit), escaped(metric.help));
    return html + "</dl></details>\n";
}

std::string growth_details(const EffectFindings& effect) {
    const std::vector<EffectPlot> plots = growth_plots(effect);
    if (plots.empty()) return "";
    std::string html = "<h3>How it grows</h3>\n" + figures(plots, "small");
    for (const Growth& growth : effect.growth) {
        if (growth.left_out.empty()) continue;
        std::string names;
        for (const std::string& name : growth.left_out)
            names += (names.empty() ? "" : ", ") + name;
        html += fmt::format("<p class=\"note\">Too slow for growth over {}: {}.</p>\n", growth.over,
                            escaped(names));
    }
    return html;
}

} // namespace

std::string effect_section(const EffectFindings& effect, const Conditions& conditions,
                           const std::map<std::string, std::string>& pictures) {
    std::string html =
        fmt::format("<section class=\"effect\" id=\"{0}\">\n<h2>{0}</h2>\n<p class=\"help\">{1}</p>\n",
                    escaped(effect.id), escaped(effect.help));
    bool first = true;
    for (const std::string& sentence : sentences_of(effect)) {
        const std::string text = first ? sentence.substr(effect.id.size() + 2) : sentence;
        html += fmt::format("<p{}>{}</p>\n", first ? " class=\"first\"" : "", escaped(text));
        first = false;
    }
    for (const std::string& note : effect.notes)
        html += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
    html += figures(error_plots(effect), "main");
    html += level_table(effect);
    std::string scenes;
    for (const SceneFindings& scene : effect.scenes)
        scenes += (scenes.empty() ? "" : ", ") + scene.name;
    html += fmt::format("<p class=\"note\">Means over {}; errors at {}, times at {}; values: {}.</p>\n",
                        escaped(scenes), escaped(effect.picture_size),
                        escaped(conditions.time_sizes.empty() ? "" : conditions.time_sizes.front()),
                        effect.values.empty() ? "defaults" : escaped(effect.values));
    html += thumbnails(effect, pictures) + growth_details(effect) + metric_details(effect)
            + scene_details(effect);
    return html + "</section>\n";
}

} // namespace postfx::host::study
