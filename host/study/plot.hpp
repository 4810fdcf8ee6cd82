// Plots with logarithmic axes, as SVG. Their colours are of plot_style(), for light and for dark surroundings.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace postfx::host::study {

/// A point of a scatter plot.
struct Mark {
    std::string label;
    double x = 0, y = 0;
    double x_low = 0, x_high = 0; ///< of its bar
    bool classic = false;         ///< in the other colour
    bool hollow = false;
    bool on_hull = false;
};

/// A line across, below which nothing can be known or had.
struct Floor {
    double y = 0;
    std::string label;
};

struct ScatterPlot {
    std::string title; ///< for those who can't see it
    std::string x_label, y_label;
    double y_unit = 1; ///< the axis is labelled with value / unit
    std::vector<Mark> marks;
    std::vector<Floor> floors;
    double x_floor = 0; ///< smaller ones are put here, with a sign: noise has no logarithm
    double y_floor = 0;
};
std::string scatter_svg(const ScatterPlot& plot);

/// A line of a line plot.
struct Line {
    std::string label;
    std::vector<std::pair<double, double>> points; ///< what is not positive is left out
    double shade = 1;                              ///< 0 pale to 1 full
    bool classic = false;
};

struct LinePlot {
    std::string title, x_label, y_label;
    double y_unit = 1;
    std::vector<Line> lines;
};
std::string line_svg(const LinePlot& plot);

/// CSS of both, for the page that they stand in.
std::string plot_style();
/// The same for a file of its own.
std::string standalone_svg(const std::string& svg);

/// For HTML, XML and their attributes.
std::string escaped(const std::string& text);

} // namespace postfx::host::study
