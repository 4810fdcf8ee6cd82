#include "metric.hpp"

namespace postfx::host {

ChainEntry entry_with(const Method& method, const std::map<std::string, double>& values) {
    ChainEntry entry = method.entry();
    for (const auto& [name, value] : values)
        entry.set(name, value);
    return entry;
}

std::vector<RegisteredMetric>& registered_metrics() {
    static std::vector<RegisteredMetric> metrics;
    return metrics;
}

} // namespace postfx::host
