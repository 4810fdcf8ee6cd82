#include "labels.hpp"

#include <algorithm>
#include <limits>

namespace postfx::host::study {

double Box::overlap(const Box& other) const {
    const double across = std::min(right, other.right) - std::max(left, other.left);
    const double up = std::min(bottom, other.bottom) - std::max(top, other.top);
    return across > 0 && up > 0 ? across * up : 0;
}

double text_width(const std::string& text, double size) {
    // Bytes after the first of a letter in UTF-8 take no room.
    const auto letters =
        std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
    return 0.57 * size * static_cast<double>(letters);
}

Box text_box(double x, double y, const std::string& text, double size) {
    return {x, y - 0.8 * size, x + text_width(text, size), y + 0.25 * size};
}

double LabelPlacer::cost(const Box& box) const {
    const double area = (box.right - box.left) * (box.bottom - box.top);
    double cost = 4 * (area - box.overlap(area_)); // cut off is worse than hidden
    for (const Box& other : taken_)
        cost += box.overlap(other);
    return cost;
}

LabelPlacer::Place LabelPlacer::place(double x, double y, const std::string& text, double size) {
    struct Candidate {
        double dx, dy;
        const char* anchor;
        double start; ///< of the text, in its own widths from the anchor
    };
    static constexpr Candidate candidates[] = {
        {10, 4, "start", 0},      {8, -8, "start", 0},    {8, 16, "start", 0}, {0, -11, "middle", -0.5},
        {0, 20, "middle", -0.5},  {-10, 4, "end", -1},    {-8, -8, "end", -1}, {-8, 16, "end", -1},
        {0, -25, "middle", -0.5}, {0, 34, "middle", -0.5}};
    double least = std::numeric_limits<double>::infinity();
    Place best{};
    Box best_box{};
    for (const Candidate& candidate : candidates) {
        const double at_x = x + candidate.dx, at_y = y + candidate.dy;
        const Box box = text_box(at_x + candidate.start * text_width(text, size), at_y, text, size);
        const double found = cost(box);
        if (found >= least) continue;
        least = found;
        best = {at_x, at_y, candidate.anchor};
        best_box = box;
    }
    avoid(best_box);
    return best;
}

void spread_out(std::vector<EndLabel>& labels, double top, double bottom, double step) {
    std::sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    double above = top - step;
    for (EndLabel& label : labels)
        above = label.y = std::max(label.y, above + step);
    double below = bottom + step;
    for (auto label = labels.rbegin(); label != labels.rend(); ++label)
        below = label->y = std::min(label->y, below - step);
}

} // namespace postfx::host::study
