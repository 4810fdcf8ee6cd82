#include <image/matches_sample.hpp>

#include <half.h>

#include <cmath>

namespace postfx {

bool matches_sample(double wanted, float sample, const Coding& coding) {
    if (std::isnan(wanted) || std::isnan(sample)) return std::isnan(wanted) && std::isnan(sample);
    switch (coding.numbers) {
    case Coding::Numbers::single:
        return static_cast<float>(wanted) == sample;
    case Coding::Numbers::half:
        return static_cast<float>(Imath::half(static_cast<float>(wanted))) == sample;
    case Coding::Numbers::codes: {
        const double largest = std::ldexp(1.0, coding.bits) - 1;
        return std::round(wanted * largest) == std::round(static_cast<double>(sample) * largest);
    }
    }
    return false;
}

} // namespace postfx
