// A logarithmic axis.
#pragma once

#include <string>
#include <vector>

namespace postfx::host::study {

/// Values to pixels along one axis of a plot.
class LogScale {
public:
    /// Spans the positive values with a little room on both sides, at least a factor of 4; 0.1 to 10 without any.
    /// `from` and `to`: pixels of the low and the high end.
    LogScale(const std::vector<double>& values, double from, double to);

    double low() const { return low_; }
    double high() const { return high_; }
    /// Where a value is; what lies beyond an end is put there.
    double at(double value) const;

    struct Tick {
        double value;
        bool labelled; ///< others are lines only
    };
    /// 1, 2, 5 of every decade on short axes, else powers of 10, every second or third of them on very long ones.
    std::vector<Tick> ticks() const;

private:
    double low_, high_, from_, to_;
};

/// "0.002", "15", "1,500" without needless digits.
std::string tick_text(double value);

} // namespace postfx::host::study
