// Names beside marks, where they hide nothing.
#pragma once

#include <string>
#include <vector>

namespace postfx::host::study {

struct Box {
    double left, top, right, bottom;
    double overlap(const Box& other) const; ///< area
};

/// About, for a sans-serif font of that size in pixels.
double text_width(const std::string& text, double size);
/// Of a text that begins at x on the line y.
Box text_box(double x, double y, const std::string& text, double size);

class LabelPlacer {
public:
    /// Labels stay inside of `area`.
    explicit LabelPlacer(Box area) : area_(area) {}

    void avoid(Box box) { taken_.push_back(box); }

    struct Place {
        double x, y;
        const char* anchor;
    };
    /// Around (x, y), where the least is hidden; to the right if nothing is. Later labels avoid this one.
    Place place(double x, double y, const std::string& text, double size);

private:
    double cost(const Box& box) const;

    Box area_;
    std::vector<Box> taken_;
};

/// A name at the right end of a line.
struct EndLabel {
    double y;
    std::string text;
    bool classic = false;
};

/// Move names apart vertically, keeping their order, so that they are `step` apart and within [top, bottom] if there
/// is room.
void spread_out(std::vector<EndLabel>& labels, double top, double bottom, double step);

} // namespace postfx::host::study
