#include "plot.hpp"

#include "labels.hpp"
#include "log_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host::study {
namespace {

constexpr double width = 480, height = 330;
constexpr double left = 62, right = 466, top = 14, bottom = 280;

std::string open_svg(const std::string& title) {
    return fmt::format("<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" "
                       "role=\"img\" aria-label=\"{}\">\n",
                       width, height, escaped(title));
}

std::string text_at(double x, double y, const char* style, const char* anchor, const std::string& text) {
    return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", style,
                       x, y, anchor, escaped(text));
}

std::string line_at(double x0, double y0, double x1, double y1, const char* style) {
    return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                       style, x0, y0, x1, y1);
}

std::string axes(const LogScale& x, const LogScale& y, const std::string& x_label,
                 const std::string& y_label) {
    std::string svg;
    for (const LogScale::Tick& tick : x.ticks()) {
        const double at = x.at(tick.value);
        svg += line_at(at, top, at, bottom, "grid");
        if (tick.labelled) svg += text_at(at, bottom + 17, "tick", "middle", tick_text(tick.value));
    }
    for (const LogScale::Tick& tick : y.ticks()) {
        const double at = y.at(tick.value);
        svg += line_at(left, at, right, at, "grid");
        if (tick.labelled) svg += text_at(left - 7, at + 4, "tick", "end", tick_text(tick.value));
    }
    svg += line_at(left, bottom, right, bottom, "axis") + line_at(left, top, left, bottom, "axis");
    svg += text_at((left + right) / 2, height - 12, "axis-label", "middle", x_label);
    svg += fmt::format("<text class=\"axis-label\" transform=\"translate(14 {:.1f}) rotate(-90)\" "
                       "text-anchor=\"middle\">{}</text>\n",
                       (top + bottom) / 2, escaped(y_label));
    return svg;
}

/// Ticks of an axis in units of the axis.
std::vector<double> scaled(std::vector<double> values, double unit) {
    for (double& value : values)
        value /= unit;
    return values;
}

std::string polyline(const std::vector<std::pair<double, double>>& points, const std::string& attributes) {
    std::string path;
    for (const auto& [x, y] : points)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x, y);
    return fmt::format("<path {} d=\"{}\"/>\n", attributes, path);
}

std::string mark_svg(const Mark& mark, double x, double y) {
    const char* color = mark.classic ? "classic" : "level";
    const char* fill = mark.hollow ? "hollow" : "full";
    const std::string at = fmt::format("class=\"mark {} {}\"", color, fill);
    if (mark.classic) {
        constexpr double side = 10;
        return fmt::format("<rect {} x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:g}\" height=\"{:g}\"/>\n", at,
                           x - side / 2, y - side / 2, side, side);
    }
    return fmt::format("<circle {} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5.5\"/>\n", at, x, y);
}

/// Small boxes along a line, close enough for no letter to fit between.
void avoid_line(LabelPlacer& labels, const std::vector<std::pair<double, double>>& points) {
    constexpr double step = 4, half = 1.5;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto [x0, y0] = points[i - 1];
        const auto [x1, y1] = points[i];
        const int count = static_cast<int>(std::hypot(x1 - x0, y1 - y0) / step);
        for (int k = 0; k <= count; ++k) {
            const double share = static_cast<double>(k) / std::max(count, 1);
            const double x = std::lerp(x0, x1, share), y = std::lerp(y0, y1, share);
            labels.avoid({x - half, y - half, x + half, y + half});
        }
    }
}

} // namespace

std::string scatter_svg(const ScatterPlot& plot) {
    const auto held = [](double value, double floor) {
        return std::isfinite(value) ? std::max(value, floor) : floor;
    };
    std::vector<double> xs, ys;
    for (const Mark& mark : plot.marks) {
        xs.insert(xs.end(), {held(mark.x, plot.x_floor), held(mark.x_high, plot.x_floor)});
        ys.push_back(held(mark.y, plot.y_floor));
    }
    for (const Floor& floor : plot.floors)
        ys.push_back(floor.y);
    const LogScale x(xs, left, right), y(scaled(ys, plot.y_unit), bottom, top);
    const auto x_at = [&](double value) { return x.at(held(value, plot.x_floor)); };
    const auto y_at = [&](double value) { return y.at(held(value, plot.y_floor) / plot.y_unit); };

    std::string svg = open_svg(plot.title) + axes(x, y, plot.x_label, plot.y_label);
    LabelPlacer labels({left + 2, top, right, bottom - 2});
    for (const Floor& floor : plot.floors) {
        if (!(floor.y > 0)) continue;
        const double at = y.at(floor.y / plot.y_unit);
        svg += line_at(left, at, right, at, "floor");
        labels.avoid({left, at - 2, right, at + 2});
        const bool low = at > bottom - 16;
        svg += text_at(right - 4, low ? at - 5 : at + 13, "floor-label", "end", floor.label);
        labels.avoid(
            text_box(right - 4 - text_width(floor.label, 11), low ? at - 5 : at + 13, floor.label, 11));
    }
    std::vector<std::pair<double, double>> hull;
    for (const Mark& mark : plot.marks) {
        if (mark.on_hull) hull.emplace_back(x_at(mark.x), y_at(mark.y));
    }
    std::sort(hull.begin(), hull.end());
    if (hull.size() > 1) svg += polyline(hull, "class=\"hull\"");
    avoid_line(labels, hull);
    for (const Mark& mark : plot.marks) {
        const double px = x_at(mark.x), py = y_at(mark.y);
        svg +=
            line_at(x_at(mark.x_low), py, x_at(mark.x_high), py, mark.classic ? "bar classic" : "bar level");
        labels.avoid({px - 7, py - 7, px + 7, py + 7});
    }
    for (const Mark& mark : plot.marks)
        svg += mark_svg(mark, x_at(mark.x), y_at(mark.y));
    for (const Mark& mark : plot.marks) {
        const std::string sign = mark.x < plot.x_floor ? "\xe2\x89\xa4 " : ""; // less or equal
        const LabelPlacer::Place place = labels.place(x_at(mark.x), y_at(mark.y), sign + mark.label, 12.5);
        svg += text_at(place.x, place.y, mark.classic ? "label classic" : "label level", place.anchor,
                       sign + mark.label);
    }
    return svg + "</svg>\n";
}

std::string line_svg(const LinePlot& plot) {
    std::vector<double> xs, ys;
    for (const Line& line : plot.lines) {
        for (const auto& [px, py] : line.points) {
            if (!(px > 0) || !(py > 0)) continue;
            xs.push_back(px);
            ys.push_back(py / plot.y_unit);
        }
    }
    constexpr double names = 118; // room for the lines' names at their right ends
    const LogScale x(xs, left, right - names), y(ys, bottom, top);
    std::string svg = open_svg(plot.title);
    std::string drawn = axes(x, y, plot.x_label, plot.y_label);
    std::vector<EndLabel> ends;
    for (const Line& line : plot.lines) {
        std::vector<std::pair<double, double>> points;
        for (const auto& [px, py] : line.points) {
            if (px > 0 && py > 0) points.emplace_back(x.at(px), y.at(py / plot.y_unit));
        }
        if (points.empty()) continue;
        const char* color = line.classic ? "classic" : "level";
        const double opacity = line.classic ? 1 : 0.35 + 0.65 * line.shade;
        drawn += polyline(points, fmt::format("class=\"curve {}\" opacity=\"{:.2f}\"", color, opacity));
        for (const auto& [px, py] : points)
            drawn += fmt::format(
                "<circle class=\"dot {}\" opacity=\"{:.2f}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\"/>\n",
                color, opacity, px, py);
        ends.push_back({points.back().second, line.label, line.classic});
    }
    spread_out(ends, top + 8, bottom - 4, 15);
    for (const EndLabel& end : ends)
        drawn += text_at(right - names + 8, end.y + 4, end.classic ? "label classic" : "label level", "start",
                         end.text);
    return svg + drawn + "</svg>\n";
}

std::string plot_style() {
    return R"(.plot{--ink:#1f2733;--soft:#5f6b7a;--rule:#e3e1da;--level:#1f5fa8;--classic:#b8500f;--ground:#fffefb;
font-family:system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
.plot text{fill:var(--ink);font-size:12px}
.plot .tick{fill:var(--soft);font-size:11.5px}
.plot .axis-label{fill:var(--soft);font-size:12px}
.plot .grid{stroke:var(--rule);stroke-width:1}
.plot .axis{stroke:var(--soft);stroke-width:1}
.plot .floor{stroke:var(--soft);stroke-width:1.2;stroke-dasharray:5 4}
.plot .floor-label{fill:var(--soft);font-size:11px;font-style:italic}
.plot .hull{fill:none;stroke:var(--level);stroke-width:1.6;opacity:.55}
.plot .bar{stroke-width:2;opacity:.45}
.plot .level{stroke:var(--level)}.plot .classic{stroke:var(--classic)}
.plot .mark{stroke-width:2}
.plot .mark.level.full{fill:var(--level)}.plot .mark.classic.full{fill:var(--classic)}
.plot .mark.hollow{fill:var(--ground)}
.plot .curve{fill:none;stroke-width:2}
.plot .dot.level{fill:var(--level)}.plot .dot.classic{fill:var(--classic)}
.plot .label{font-size:12.5px;font-weight:600;stroke:none}
.plot .label.level{fill:var(--level)}.plot .label.classic{fill:var(--classic)}
@media (prefers-color-scheme:dark){.plot{--ink:#e6e8ec;--soft:#9aa5b4;--rule:#2b313b;--level:#82b6f5;
--classic:#f2a365;--ground:#181c23}}
)";
}

std::string standalone_svg(const std::string& svg) {
    const std::size_t end = svg.find(">\n") + 2;
    return svg.substr(0, end)
           + fmt::format(
               "<style>{}</style>\n<rect width=\"100%\" height=\"100%\" style=\"fill:var(--ground)\"/>\n",
               plot_style())
           + svg.substr(end);
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        switch (letter) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += letter;
        }
    }
    return result;
}

} // namespace postfx::host::study
