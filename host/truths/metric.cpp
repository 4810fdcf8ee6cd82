#include "metric.hpp"

namespace postfx::host {

std::vector<RegisteredMetric>& registered_metrics() {
    static std::vector<RegisteredMetric> metrics;
    return metrics;
}

} // namespace postfx::host
