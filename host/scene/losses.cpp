#include "losses.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace postfx::host {

void Losses::add(const LossKind& kind, const std::string& what, std::size_t count) {
    if (count == 0) return;
    const auto known =
        std::find_if(losses_.begin(), losses_.end(), [&](const Loss& loss) { return loss.kind == kind; });
    if (known == losses_.end()) {
        losses_.push_back({kind, what, count});
    } else {
        known->count += count;
    }
}

std::vector<std::string> Losses::lines() const {
    std::vector<std::string> result;
    for (const Loss& loss : losses_) {
        result.push_back(fmt::format("{} {}{}", loss.count, loss.count == 1 ? loss.kind.one : loss.kind.many,
                                     loss.first.empty() ? std::string()
                                     : loss.count == 1  ? fmt::format(" ({})", loss.first)
                                                        : fmt::format(" (first: {})", loss.first)));
    }
    return result;
}

} // namespace postfx::host
