#include "log_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::host::study {

LogScale::LogScale(const std::vector<double>& values, double from, double to)
    : low_(0.1), high_(10), from_(from), to_(to) {
    std::vector<double> usable;
    for (const double value : values) {
        if (value > 0 && std::isfinite(value)) usable.push_back(value);
    }
    if (usable.empty()) return;
    const auto [smallest, largest] = std::minmax_element(usable.begin(), usable.end());
    constexpr double narrowest = 4, room = 0.08; // of the span in logarithms
    double low = std::log(*smallest), high = std::log(*largest);
    const double lacking = std::log(narrowest) - (high - low);
    if (lacking > 0) {
        low -= lacking / 2;
        high += lacking / 2;
    }
    const double margin = room * (high - low);
    low_ = std::exp(low - margin);
    high_ = std::exp(high + margin);
}

double LogScale::at(double value) const {
    const double held = std::clamp(value, low_, high_);
    return from_ + (to_ - from_) * std::log(held / low_) / std::log(high_ / low_);
}

std::vector<LogScale::Tick> LogScale::ticks() const {
    const double decades = std::log10(high_ / low_);
    const int every = decades <= 6 ? 1 : static_cast<int>(std::ceil(decades / 5));
    std::vector<Tick> ticks;
    const int first = static_cast<int>(std::floor(std::log10(low_)));
    const int last = static_cast<int>(std::ceil(std::log10(high_)));
    for (int power = first; power <= last; ++power) {
        for (const int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10.0, power);
            const bool labelled = digit == 1 ? power % every == 0 : decades < 2.2;
            if (value < low_ * (1 - 1e-9) || value > high_ * (1 + 1e-9) || (digit != 1 && decades > 4))
                continue;
            ticks.push_back({value, labelled});
        }
    }
    return ticks;
}

std::string tick_text(double value) {
    if (value >= 1e7 || value < 0.9999e-4) return fmt::format("{:.0e}", value);
    if (value >= 999.5) {
        const int whole = static_cast<int>(std::lround(value));
        return whole < 1'000'000
                   ? fmt::format("{},{:03}", whole / 1000, whole % 1000)
                   : fmt::format("{},{:03},{:03}", whole / 1'000'000, whole / 1000 % 1000, whole % 1000);
    }
    return fmt::format("{:.4g}", value);
}

} // namespace postfx::host::study
